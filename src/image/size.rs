//! How large a picture a format can hold.

use super::{Format, OutputError, exr};

/// Width and height that a PNG can have at most.
const PNG_MOST: u32 = i32::MAX as u32;

/// The error that says so.
pub(super) fn size_error(format: Format, width: u32, rows: u32, problem: String) -> OutputError {
    OutputError::Size {
        width,
        rows,
        format,
        problem,
    }
}

/// Whether the format can hold a picture of this size.
///
/// # Errors
/// [`OutputError::Size`] if it cannot.
pub fn check_size(format: Format, width: u32, rows: u32) -> Result<(), OutputError> {
    let problem = if width == 0 || rows == 0 {
        "it has no pixels".into()
    } else if format == Format::Png && width.max(rows) > PNG_MOST {
        format!("the most is {PNG_MOST} each way")
    } else if format == Format::Exr && u64::from(width) * u64::from(rows) > exr::MAX_PIXELS {
        format!(
            "it is kept in memory, {} million pixels at most; PNG and PPM have no such limit",
            exr::MAX_PIXELS / 1_000_000
        )
    } else {
        return Ok(());
    };
    Err(size_error(format, width, rows, problem))
}
