//! How a reproduction came about, as fields of XMP: profile, chart, light, settings.

use darkroot_colour::temperature::Temperature;
use darkroot_develop::Plan;
use darkroot_profile::Profile;

use crate::from_chart::{Told, file_name};
use crate::light::LightSource;
use crate::metadata::{DARKROOT, Xmp};
use crate::settings::{Key, Settings};
use crate::{ChosenProfile, files};

/// Mireds from the white of a photograph up to which a profile's light is that of the photograph.
const NEAR: f64 = 50.0;

/// What is known of a reproduction.
pub(crate) struct Known<'a> {
    /// Name of the raw file, and SHA-256 of its bytes.
    pub(crate) raw: (String, String),
    pub(crate) settings: &'a Settings,
    pub(crate) profile: Option<&'a ChosenProfile<'a>>,
    pub(crate) chart: Option<&'a Told>,
    pub(crate) plan: &'a Plan,
}

/// Names and values of the fields: names of files without their folders, hashes, the light, and every setting that is not its
/// default. What is not known is empty.
pub(crate) fn fields(known: &Known<'_>) -> Vec<(&'static str, String)> {
    let mut fields = vec![("RawFile", known.raw.0.clone()), ("RawSha256", known.raw.1.clone())];
    if let Some(chosen) = known.profile {
        fields.push(("Profile", chosen.profile.camera().name()));
        fields.push(("ProfilePlace", file_name(chosen.place.as_ref().as_ref())));
        if !chosen.estimated {
            fields.push(("ProfileSha256", hash_of(chosen)));
        }
    }
    let profile = known.profile.map(|chosen| chosen.profile.as_ref());
    fields.extend(light_of(known.settings, profile, known.plan).map(|light| ("Light", light)));
    if let Some(told) = known.chart {
        fields.push(("ChartShot", file_name(&told.path)));
        fields.push(("ChartShotSha256", told.sha256.clone()));
        fields.push(("Chart", told.chart.clone()));
        fields.push(("ChartReference", told.reference.0.clone()));
        fields.push(("ChartReferenceSha256", told.reference.1.clone()));
        fields.push(("ChartWhiteLightness", format!("{:.3}", told.lightness)));
    }
    fields.push(("Exposure", format!("{:.5}", known.plan.gain)));
    fields.push(("Settings", settings_in_words(known.settings)));
    fields
}

/// SHA-256 of the profile's file, or of the profile as a file where it is built in.
fn hash_of(chosen: &ChosenProfile<'_>) -> String {
    let bytes = files::read_text(chosen.place.as_ref().as_ref());
    let bytes = bytes.unwrap_or_else(|_| darkroot_profile::file::format(&chosen.profile).into_bytes());
    files::sha256(&bytes)
}

/// The light that the colours are for: the one that was named, the profile's where the white is near to it, or what the
/// white tells.
pub(crate) fn light_of(settings: &Settings, profile: Option<&Profile>, plan: &Plan) -> Option<String> {
    if let Some(light) = &settings.light {
        return Some(light.light.name.clone());
    }
    let white = plan.white?;
    let away = |kelvin: f64| (1e6 / kelvin - 1e6 / white.kelvin).abs();
    let calibrations = profile.map(Profile::calibrations).unwrap_or_default();
    let nearest =
        calibrations.iter().min_by(|a, b| away(a.light.kelvin()).total_cmp(&away(b.light.kelvin())));
    let named = nearest.filter(|c| away(c.light.kelvin()) <= NEAR && c.light.kelvin() > 0.0);
    Some(named.map_or_else(|| in_kelvin(white), |c| c.light.name.clone()))
}

fn in_kelvin(white: Temperature) -> String {
    format!("{:.0} K", white.kelvin)
}

/// The light of a name as [`light_of`] gives it.
pub(crate) fn by_name(name: &str) -> Option<LightSource> {
    LightSource::by_name(&name.replace(" K", "K"))
}

/// Name and text of every setting that was asked for; of files the name alone.
fn settings_in_words(settings: &Settings) -> String {
    let one = |(name, text): &(&'static str, String)| {
        let is_file = Key::from_name(name).is_some_and(|key| key.is_file(text));
        let text = if is_file { file_name(text.as_ref()) } else { text.clone() };
        // A spectrum stands for the light that it is named for.
        let text = text.split_once('@').map_or(text.clone(), |(name, _)| name.to_owned());
        format!("{name}={text}")
    };
    settings.told.iter().map(one).collect::<Vec<_>>().join("; ")
}

/// The light that a packet of XMP says a reproduction is for; `None` where it says none.
pub(crate) fn light_in(packet: &[u8]) -> Option<LightSource> {
    let xmp = Xmp::parse(std::str::from_utf8(packet).ok()?).ok()?;
    by_name(&xmp.text(DARKROOT, "Light")?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_light_is_read_back_from_attributes_and_elements() {
        let packet = |inner: &str| {
            format!(
                "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\" xmlns:d=\"{DARKROOT}\"><r:RDF \
                 xmlns:r=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">{inner}</r:RDF></x:xmpmeta>"
            )
        };
        let kelvin =
            |inner: &str| light_in(packet(inner).as_bytes()).map(|light| light.light.kelvin().round());
        assert_eq!(kelvin("<r:Description d:Light=\"A\"/>"), Some(2856.0));
        assert_eq!(kelvin("<r:Description><d:Light>3200 K</d:Light></r:Description>"), Some(3200.0));
        assert_eq!(kelvin("<r:Description d:Light=\"moonshine\"/>"), None);
        assert_eq!(light_in(b"\xff\xfe no text"), None);
        assert_eq!(light_in(b"<a><b></a>"), None);
    }
}
