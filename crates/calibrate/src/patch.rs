//! A patch of a chart: as it was measured, and with what a model makes of it.

use std::borrow::Cow;
use std::sync::OnceLock;

use darkroot_chart::ReferenceColour;
use darkroot_colour::adaptation::bradford;
use darkroot_colour::difference::de2000;
use darkroot_colour::measured::Measured;
use darkroot_colour::spectrum::SAMPLES;
use darkroot_colour::{Spectrum, Vector3, Xyz, white};
use darkroot_profile::Patch;
use darkroot_profile::fit::recovered::Recovery;

use crate::LightSource;

/// Share of clipped samples from which a patch counts as clipped.
const CLIPPED: f64 = 0.001;

/// A patch of a chart with what the camera made of it.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredPatch {
    /// Its name.
    pub name: String,
    /// Camera RGB, not balanced, 1 = the white level.
    pub rgb: [f64; 3],
    /// Standard error of that.
    pub uncertainty: [f64; 3],
    /// Share of clipped samples.
    pub clipped: f64,
    /// What it really is.
    pub reference: ReferenceColour,
    /// Why it takes no part in the fit, if it does not.
    pub excluded: Option<String>,
}

impl MeasuredPatch {
    /// Whether it has clipped samples.
    pub fn is_clipped(&self) -> bool {
        is_clipped(self.clipped)
    }
}

/// Whether a patch with this share of clipped samples counts as clipped.
pub(crate) fn is_clipped(share: f64) -> bool {
    share > CLIPPED
}

/// A patch with what the model makes of it; XYZ relative to D50.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedPatch {
    /// Its name.
    pub name: String,
    /// Balanced camera RGB.
    pub rgb: [f64; 3],
    /// Standard error of the camera RGB, relative.
    pub uncertainty: [f64; 3],
    /// What it should be.
    pub reference: Xyz,
    /// What the model makes of it.
    pub corrected: Xyz,
    /// CIEDE2000 between both.
    pub de2000: f64,
    /// CIEDE2000 by a model that was fitted without it; none for patches that take no part.
    pub left_out: Option<f64>,
    /// Why it takes no part in the fit, if it does not.
    pub excluded: Option<String>,
}

impl JudgedPatch {
    pub(crate) fn new(
        patch: &MeasuredPatch,
        rgb: [f64; 3],
        reference: Xyz,
        corrected: Xyz,
        unseen: Option<Xyz>,
    ) -> Self {
        let off = |c: Xyz| de2000(c.lab(white::D50), reference.lab(white::D50));
        Self {
            name: patch.name.clone(),
            rgb,
            uncertainty: [0, 1, 2].map(|c| patch.uncertainty[c] / patch.rgb[c].abs().max(1e-6)),
            reference,
            corrected,
            de2000: off(corrected),
            left_out: unseen.map(off),
            excluded: patch.excluded.clone(),
        }
    }

    pub(crate) fn for_profile(&self) -> Patch {
        // Six digits are more than any measurement has.
        let round = |v: f64| (v * 1e6).round() / 1e6;
        let Xyz { x, y, z } = self.reference;
        Patch {
            name: self.name.clone(),
            rgb: self.rgb.map(round),
            xyz: Xyz::new(round(x), round(y), round(z)),
            de2000: round(self.de2000),
        }
    }
}

/// The patches, with the most probable reflectances where the reference has only colours under D50 and the light's spectrum
/// is known. What was done, and how far it can be off, comes to `notes`.
pub(crate) fn with_spectra<'a>(
    patches: &'a [MeasuredPatch],
    light: &LightSource,
    notes: &mut Vec<String>,
) -> Cow<'a, [MeasuredPatch]> {
    static RECOVERY: OnceLock<Option<Recovery>> = OnceLock::new();
    let known = |p: &MeasuredPatch| p.reference.spectrum().is_some();
    let recovery = RECOVERY.get_or_init(Recovery::builtin);
    let (Some(spectrum), Some(recovery)) = (&light.spectrum, recovery) else { return Cow::Borrowed(patches) };
    if patches.iter().all(known) {
        return Cow::Borrowed(patches);
    }
    let nm: Vec<f64> = (0..SAMPLES).map(Spectrum::wavelength).collect();
    let (mut uncertain, mut count) = (0.0, 0.0);
    let mut recovered = |patch: &MeasuredPatch| {
        let found = recovery.of(patch.reference.xyz_d50()).filter(|_| !known(patch));
        let measured = found.as_ref().and_then(|f| Measured::new(&nm, &f.reflectance.0).ok());
        if let Some(found) = found {
            uncertain += found.uncertainty(spectrum);
            count += 1.0;
        }
        let reference = measured.map_or_else(|| patch.reference.clone(), ReferenceColour::Reflectance);
        MeasuredPatch { reference, ..patch.clone() }
    };
    let patches: Vec<MeasuredPatch> = patches.iter().map(&mut recovered).collect();
    notes.push(format!(
        "the reference has colours under D50, not spectra: the most probable spectra were taken, whose colours under {} can \
         be off by dE2000 {:.1}; a spectral reference would be exact",
        light.light.name,
        uncertain / f64::max(count, 1.0)
    ));
    Cow::Owned(patches)
}

/// How reference colours become XYZ under the light.
pub(crate) struct Reference<'a> {
    light: &'a LightSource,
    from_d50: darkroot_colour::Matrix3,
}

impl<'a> Reference<'a> {
    pub(crate) fn new(
        patches: &[MeasuredPatch],
        light: &'a LightSource,
        light_white: Xyz,
        notes: &mut Vec<String>,
    ) -> Self {
        let spectral =
            patches.iter().filter(|p| matches!(p.reference, ReferenceColour::Reflectance(_))).count();
        let name = &light.light.name;
        if spectral < patches.len() && name != "D50" {
            notes.push(format!(
                "the reference has colours under D50, not spectra: they are adapted to {name} (Bradford), which is an \
                 approximation; a spectral reference would be exact"
            ));
        }
        if spectral > 0 && light.spectrum.is_none() {
            notes.push(format!(
                "the spectrum of the light {name} is not known: reference colours are those under D50, adapted to its \
                 white; name a lamp (LED-B3, FL11, a file) or a temperature for exact ones"
            ));
        }
        Self { light, from_d50: bradford(white::D50, light_white) }
    }

    /// XYZ of a patch under the light, relative to its white.
    pub(crate) fn xyz(&self, patch: &MeasuredPatch) -> Xyz {
        match (&self.light.spectrum, patch.reference.spectrum()) {
            (Some(light), Some(reflectance)) => reflectance.reflected_xyz(light),
            _ => Xyz::from(self.from_d50 * Vector3::from(patch.reference.xyz_d50())),
        }
    }
}
