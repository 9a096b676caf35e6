//! The proof that no number on the GPU overflows: all numbers of all records are of moderate size, but for those that
//! say in [`records`](crate::shader::records) why they need not be (docs/NUMERICS.md, section 9, "Ranges").

use super::Packed;
use crate::shader::binding::BINDINGS;
use crate::shader::bounds::{LARGEST, MOST_CONDITION};
use crate::shader::record::Record as _;

impl Packed {
    /// Why no bound is to be relied on: a number so large that products of such numbers might overflow.
    pub(super) fn doubtful_numbers(&self) -> Option<&'static str> {
        let camera = &self.camera.numbers;
        let far = f64::from(self.camera.condition) <= MOST_CONDITION
            && camera.fits()
            && camera.step.iter().all(|s| f64::from(*s) < 1024.0)
            && f64::from(camera.gain) >= 1.0 / LARGEST
            && f64::from(self.dark) > 1.0 / LARGEST / LARGEST;
        if !far {
            return Some("the camera's numbers are too large or too small");
        }
        if self
            .lit
            .as_ref()
            .is_some_and(|lit| lit.unnumbered_light_on_surface)
        {
            return Some("a light after the first 32 lies on a surface");
        }
        // Whatever may be uploaded or written as literals, whether this shader has it or not.
        let contents = BINDINGS.iter().filter_map(|binding| binding.contents);
        let fit = contents
            .map(|contents| contents(self))
            .all(|elements| elements.fit());
        (!fit).then_some("an object's or light's numbers are too large")
    }
}
