//! What the decoder takes for a file in memory, the median of seven: `decode_time FILE`.

use std::io::Write as _;
use std::time::{Duration, Instant};

use darkroot_raw::{Decoder, Limits, decode};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args_os().nth(1).ok_or("decode_time FILE")?;
    let bytes = std::fs::read(path)?;
    let mut times = Vec::new();
    for _ in 0..7 {
        let start = Instant::now();
        decode(&bytes, Decoder::default(), &Limits::default())?;
        times.push(start.elapsed());
    }
    times.sort_unstable();
    let middle = 1e3 * times.get(3).map_or(0.0, Duration::as_secs_f64);
    writeln!(std::io::stdout(), "{middle:.0} ms")?;
    Ok(())
}
