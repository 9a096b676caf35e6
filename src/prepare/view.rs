//! How a scene is looked at: what `prepare` has to know beyond the scene itself.

/// How the scene is looked at, beyond what it says itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// τ: a hit on a plane counts only where its z is ≤ this; 0 in the notes.
    pub screen_tolerance: f64,
    /// How far from its pixel's center a ray may pass, in pixels: 0, or ½ with several samples.
    pub margin: f64,
}

impl View {
    /// The view for a number of samples a pixel.
    pub fn new(screen_tolerance: f64, samples: u32) -> Self {
        Self {
            screen_tolerance,
            margin: if samples > 1 { 0.5 } else { 0.0 },
        }
    }
}

impl From<f64> for View {
    /// The view with this screen tolerance, a ray a pixel.
    fn from(screen_tolerance: f64) -> Self {
        Self::new(screen_tolerance, 1)
    }
}
