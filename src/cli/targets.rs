//! Where the pictures of a scene go.

use std::path::Path;

use anyhow::Result;
use plumb::image::Target;

use super::args::RenderOptions;
use super::destination::Destination;

/// Where the picture goes, and the one of its verdicts.
pub(crate) struct Targets {
    pub(crate) picture: Target,
    pub(crate) verdicts: Option<Target>,
}

impl Targets {
    /// Of the scene with this file.
    pub(crate) fn new(options: &RenderOptions, file: Option<&Path>) -> Result<Self> {
        let picture = Destination::of(options.output.as_deref()).target(file)?;
        let verdicts = options.verdicts.as_deref();
        let verdicts = verdicts.map(|path| Destination::of(Some(path)).target(file));
        Ok(Self {
            picture,
            verdicts: verdicts.transpose()?,
        })
    }
}
