//! Opens a raw file in memory, renders a preview and a part pixel for pixel, and writes the preview as a JPEG.
//!
//! `cargo run --release -p darkroot --example view -- FILE.NEF preview.jpg`

use std::error::Error;

use darkroot::{Cancel, Format, Limits, Photo, ProfileStore, Scale, Settings, View, encode_picture};
use darkroot_photo::Rect;

fn main() -> Result<(), Box<dyn Error>> {
    let [input, output] = std::env::args().skip(1).collect::<Vec<_>>().try_into().map_err(|_| "FILE OUT")?;
    let photo = Photo::open(&std::fs::read(input)?, &Limits::default())?;
    let analysis = photo.analyse();
    let plan = photo.plan(&analysis, &ProfileStore::builtin(), &Settings::default())?;

    let preview = plan.render(plan.whole(Scale::to_show(plan.size(), 1400)), &Cancel::default())?;
    let middle = Rect { x: plan.size().width / 2, y: plan.size().height / 2, width: 256, height: 256 };
    let part = plan.render(View::of(middle), &Cancel::default())?;
    eprintln!(
        "{} x {} and {} x {}",
        preview.size.width, preview.size.height, part.size.width, part.size.height
    );

    std::fs::write(output, encode_picture(&preview, Format::Jpeg, photo.capture())?)?;
    Ok(())
}
