//! What panels say that the user wants done; [`app`](super::app) does it.

use super::rendering::Rendering;
use crate::edit::{Target, Value};

/// What the user wants done.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Wanted {
    /// A value changed, on top of the file.
    Set(Target, Value),
    /// The file's value again.
    Reset(Target),
    /// The file's values again, all of them.
    Discard,
    /// The picture rendered otherwise.
    Render(Rendering),
    /// The changes written into the file.
    Save,
    /// The camera's block copied.
    CopyCamera,
    /// The picture saved.
    SavePicture,
    /// The last step taken back.
    Undo,
    /// It done again.
    Redo,
}
