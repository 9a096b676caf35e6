//! What the text calls that is written by hand.

pub(super) use super::primary::find_closest_object;
