//! Smooth reflectances from a formula of three numbers, fitted to a colour.

use darkroot_colour::{Lab, Matrix3, Spectrum, Vector3, Xyz};

/// Wavelength where the polynomial of [`sigmoid`] has its origin, and its unit, nm.
const CENTRE_NM: f64 = 560.0;
const UNIT_NM: f64 = 100.0;

/// Most steps of Newton's method; a fit takes about ten.
const STEPS: usize = 60;

/// The light under which [`of_lab`] sees: CIE daylight of 5003 K (D50).
pub fn reference_light() -> Spectrum {
    Spectrum::daylight(5003.0)
}

/// A reflectance between 0 and 1: s(c0 + c1 t + c2 t^2) with s(x) = 1/2 + x / (2 sqrt(1 + x^2)) and t in units of
/// 100 nm from 560 nm (Jakob and Hanika, "A Low-Dimensional Function Space for Efficient Spectral Upsampling",
/// Computer Graphics Forum 38(2), 2019).
pub fn sigmoid(c: [f64; 3]) -> Spectrum {
    Spectrum::from_fn(|nm| {
        let t = (nm - CENTRE_NM) / UNIT_NM;
        let x = c[0] + t * (c[1] + t * c[2]);
        0.5 + x / (2.0 * (1.0 + x * x).sqrt())
    })
}

/// The [`sigmoid`] reflectance that has the colour `lab` under [`reference_light`] for the 2-degree observer.
/// For colours that no such surface has, the nearest that Newton's method finds.
pub fn of_lab(lab: Lab) -> Spectrum {
    let light = reference_light();
    let target = Vector3::from(lab.xyz(Spectrum::constant(1.0).reflected_xyz(&light)));
    let miss = |c: Vector3| Vector3::from(sigmoid(c.into()).reflected_xyz(&light)) - target;

    let grey = (2.0 * target[1] - 1.0).clamp(-0.999, 0.999);
    let mut c = Vector3::new(grey / (1.0 - grey * grey).sqrt(), 0.0, 0.0);
    let mut error = miss(c);
    for _ in 0..STEPS {
        const H: f64 = 1e-6;
        let slope = |i: usize| {
            let mut next = c;
            next[i] += H;
            (miss(next) - error) / H
        };
        let Some(inverse) = Matrix3::from_columns(&[slope(0), slope(1), slope(2)]).try_inverse() else {
            break;
        };
        let step = inverse * error;
        // Half a step where a whole one leads away.
        let better = (0..20)
            .map(|halvings| c - step / f64::from(1 << halvings))
            .map(|next| (next, miss(next)))
            .find(|(_, e)| e.norm_squared() < error.norm_squared());
        let Some(better) = better else { break };
        (c, error) = better;
    }
    sigmoid(c.into())
}

/// Colour of a reflectance under [`reference_light`], relative to the perfect diffuser.
pub fn lab_of(reflectance: &Spectrum) -> Lab {
    let light = reference_light();
    let white: Xyz = Spectrum::constant(1.0).reflected_xyz(&light);
    reflectance.reflected_xyz(&light).lab(white)
}

#[cfg(test)]
mod tests {
    use super::*;
    use darkroot_colour::difference::de2000;

    #[test]
    fn a_fitted_reflectance_has_its_colour() {
        for (l, a, b) in [(20.0, 0.0, 0.0), (82.0, 3.0, 80.0), (28.0, 15.0, -50.0), (42.0, 51.0, 29.0)] {
            let lab = Lab { l, a, b };
            let fitted = of_lab(lab);
            assert!(de2000(lab_of(&fitted), lab) < 1e-4, "{lab:?}");
            assert!(fitted.0.iter().all(|r| (0.0..=1.0).contains(r)));
        }
    }
}
