//! Scenes without lights.

pub(super) mod by_hand;
#[allow(
    clippy::duplicate_mod,
    reason = "it is about the types of the text beside it"
)]
#[path = "../primary.rs"]
pub(super) mod primary;
#[allow(
    clippy::duplicate_mod,
    reason = "it is about the types of the text beside it"
)]
#[path = "../row.rs"]
pub(super) mod row;
#[allow(
    clippy::all,
    unused,
    unused_comparisons,
    reason = "it is written by a program"
)]
pub(super) mod text;

use crate::certify::lanes::scene;
use crate::shader::format::Single;
use crate::shader::records;

/// A number that all lanes share.
type Number = f32;
/// The scene in f32.
type Scene<'a, S> = scene::Scene<'a, S, Single>;
