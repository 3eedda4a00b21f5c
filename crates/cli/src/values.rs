//! Values of options that are more than a word from a list.

use develop::{Balance, OutputSpace};

/// `--white-balance`.
pub(crate) fn balance(text: &str) -> Result<Balance, String> {
    let usage = || {
        format!(
            "`{text}` is no white balance: use as-shot, daylight, auto, a temperature with or without tint (5200K or \
             5200K,+8), a grey spot (spot:X,Y or spot:X,Y,SIDE), or multipliers (2.1,1,1.5)"
        )
    };
    match text {
        "as-shot" => return Ok(Balance::AsShot),
        "daylight" => return Ok(Balance::Daylight),
        "auto" => return Ok(Balance::Auto),
        _ => {}
    }
    if let Some(place) = text.strip_prefix("spot:") {
        let numbers = numbers::<usize>(place).ok_or_else(usage)?;
        return match numbers[..] {
            [x, y] => Ok(Balance::Spot { x, y, side: 32 }),
            [x, y, side] => Ok(Balance::Spot { x, y, side }),
            _ => Err(usage()),
        };
    }
    let (first, rest) = text.split_once(',').unwrap_or((text, ""));
    if let Some(kelvin) = first.strip_suffix(['K', 'k']) {
        let kelvin = kelvin.parse().map_err(|_| usage())?;
        let tint = if rest.is_empty() { 0.0 } else { rest.parse().map_err(|_| usage())? };
        return Ok(Balance::Kelvin { kelvin, tint });
    }
    match numbers::<f64>(text).as_deref() {
        Some(&[r, g, b]) => Ok(Balance::Multipliers([r, g, b])),
        _ => Err(usage()),
    }
}

/// `--space`.
pub(crate) fn space(text: &str) -> Result<OutputSpace, String> {
    darkroot::settings::space(text).ok_or_else(|| {
        let names: Vec<&str> = darkroot::settings::SPACES.iter().map(|(name, _)| *name).collect();
        format!(
            "`{text}` is no colour space: use {}, each also with -linear, aces2065-1, or camera",
            names.join(", ")
        )
    })
}

/// `--model`.
pub(crate) fn kind(text: &str) -> Result<profile::Kind, String> {
    text.parse().map_err(|e: profile::kind::UnknownKind| e.to_string())
}

/// `--corners`.
pub(crate) fn corners(text: &str) -> Result<[[f64; 2]; 4], String> {
    let usage = || format!("`{text}` is not four corners: write x,y,x,y,x,y,x,y in pixels");
    let numbers = numbers::<f64>(text).ok_or_else(usage)?;
    match numbers[..] {
        [a, b, c, d, e, f, g, h] if numbers.iter().all(|n| n.is_finite()) => {
            Ok([[a, b], [c, d], [e, f], [g, h]])
        }
        _ => Err(usage()),
    }
}

/// `--exposure`.
pub(crate) fn stops(text: &str) -> Result<f64, String> {
    const MOST: f64 = 20.0;
    let stops: Option<f64> = text.parse().ok();
    stops
        .filter(|s| s.abs() <= MOST)
        .ok_or_else(|| format!("`{text}` is no number of stops from -{MOST} to {MOST}"))
}

fn numbers<T: std::str::FromStr>(text: &str) -> Option<Vec<T>> {
    text.split(',').map(|n| n.trim().parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_balances_are_read_as_people_write_them() {
        assert_eq!(balance("as-shot"), Ok(Balance::AsShot));
        assert_eq!(balance("5200K"), Ok(Balance::Kelvin { kelvin: 5200.0, tint: 0.0 }));
        assert_eq!(balance("5200k,-8.5"), Ok(Balance::Kelvin { kelvin: 5200.0, tint: -8.5 }));
        assert_eq!(balance("spot:10,20"), Ok(Balance::Spot { x: 10, y: 20, side: 32 }));
        assert_eq!(balance("2.1,1,1.5"), Ok(Balance::Multipliers([2.1, 1.0, 1.5])));
        for wrong in ["", "warm", "5200", "5200K,", "spot:1", "1,2", "1,2,x"] {
            let accepted = wrong == "5200K,";
            assert_eq!(balance(wrong).is_ok(), accepted, "{wrong}");
        }
    }

    #[test]
    fn exposure_is_a_number_of_stops() {
        assert!((stops("-1.5").unwrap() + 1.5).abs() < 1e-12);
        assert!(stops("bright").is_err() && stops("nan").is_err() && stops("100").is_err());
    }
}
