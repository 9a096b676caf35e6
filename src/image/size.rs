//! How large a picture a format can hold.

use super::{Format, OutputError, exr};

/// Width and height that a PNG can have at most.
const PNG_MOST: u32 = i32::MAX as u32;

/// Whether the format can hold a picture of this size.
///
/// # Errors
/// [`OutputError::Size`] if it cannot.
pub fn check_size(format: Format, width: u32, rows: u32) -> Result<(), OutputError> {
    let problem = if width == 0 || rows == 0 {
        "it has no pixels".into()
    } else if format == Format::Png && width.max(rows) > PNG_MOST {
        format!("the most is {PNG_MOST} each way")
    } else if format == Format::Exr && (width > exr::MAX_WIDTH || rows > exr::MAX_ROWS) {
        format!("the most is {} × {}", exr::MAX_WIDTH, exr::MAX_ROWS)
    } else {
        return Ok(());
    };
    Err(OutputError::Size {
        width,
        rows,
        format,
        problem,
    })
}
