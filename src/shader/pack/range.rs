//! The proof that no number on the GPU leaves f32's range: all numbers of all records are of moderate size, but for
//! those that say in [`records`](crate::shader::records) why they need not be; and what products of them a shader must
//! not follow (docs/NUMERICS.md, section 9, "Ranges").

use super::{Lit, Packed};
use crate::shader::binding::Binding;
use crate::shader::bounds::{LARGEST, MOST_CONDITION, MOST_PRODUCT, WEIGHT_MOST};
use crate::shader::format::Format;
use crate::shader::record::Record as _;

/// Weights that are followed are below 2 to the power of this.
const WEIGHT_GROWTH: f64 = WEIGHT_MOST - 127.0 + 1.0;

/// The power of two that a number is below, at least 0: what it can add to a product's exponent.
fn grows(number: f64) -> f64 {
    number.log2().ceil().max(0.0)
}

/// The largest of numbers that are not negative.
fn largest(colors: impl Iterator<Item = [f64; 3]>) -> f64 {
    colors.flatten().fold(0.0, f64::max)
}

impl<F: Format> Lit<F> {
    /// What diffuse and specular reflectivities and emissivities can add to exponents.
    fn growth(&self) -> [f64; 3] {
        [
            grows(largest(self.materials.iter().map(|m| F::wide(m).diffuse))),
            grows(largest(self.materials.iter().map(|m| F::wide(m).specular))),
            grows(largest(self.lights.iter().map(|l| F::wide(l).emissivity))),
        ]
    }

    /// The largest ambient reflectivity, as it can add to an exponent.
    fn ambient_growth(&self, packed: &Packed<F>) -> f64 {
        let ambient = largest(self.materials.iter().map(|m| F::wide(m).ambient));
        let kinds = packed.kinds.iter();
        grows(
            kinds
                .map(|kind| kind.brightest(ambient))
                .fold(ambient, f64::max),
        )
    }
}

impl<F: Format> Packed<F> {
    /// Lights nearer than the inverse of this are left to the CPU, so that diffuse ∘ emissivity / distance stays below
    /// 2^MOST_PRODUCT whatever is multiplied first.
    pub(crate) fn light_nearest(&self) -> f64 {
        let unit = F::wide(&self.camera.numbers).unit;
        let [diffuse, _, emissivity] = self.lit.as_ref().map_or([0.0; 3], Lit::growth);
        2.0_f64.powf(MOST_PRODUCT - diffuse - emissivity - grows(unit))
    }

    /// Paths shorter than this are left to the CPU, so that weight · gain / path stays below 2^MOST_PRODUCT.
    pub(crate) fn total_least(&self) -> f64 {
        2.0_f64.powf(WEIGHT_GROWTH + grows(F::wide(&self.camera.numbers).gain) - MOST_PRODUCT)
    }

    /// Why no bound is to be relied on: a number so large that products of such numbers might overflow, or so small
    /// that they might vanish.
    pub(super) fn doubtful_numbers(&self) -> Option<&'static str> {
        let camera = F::wide(&self.camera.numbers);
        let far = f64::from(self.camera.condition) <= MOST_CONDITION
            && camera.fits()
            && { camera.step }.iter().all(|s| *s < 1024.0)
            && camera.gain >= 1.0 / LARGEST
            && f64::from(self.dark) > 2.0_f64.powi(-60);
        if !far {
            return Some("the camera's numbers are too large or too small");
        }
        if let Some(lit) = &self.lit {
            if lit.unnumbered_light_on_surface {
                return Some("a light after the first 32 lies on a surface");
            }
            let [diffuse, specular, emissivity] = lit.growth();
            let moderate = specular + emissivity <= MOST_PRODUCT
                && diffuse + emissivity + grows(camera.unit) <= MOST_PRODUCT
                && WEIGHT_GROWTH + grows(camera.gain) <= MOST_PRODUCT
                && lit.ambient_growth(self) <= MOST_PRODUCT;
            if !moderate {
                return Some(
                    "materials and lights are too bright together, or the scene is too small,",
                );
            }
        }
        // Whatever may be uploaded or written as literals, whether this shader has it or not.
        let contents = Binding::<F>::ALL
            .iter()
            .filter_map(|binding| binding.contents);
        let fit = contents
            .map(|contents| contents(self))
            .all(|elements| elements.fit());
        (!fit).then_some("an object's or light's numbers are too large or too small")
    }
}
