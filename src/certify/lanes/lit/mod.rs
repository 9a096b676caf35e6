//! Scenes with lights.

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
mod walk;

pub(super) use walk::MOST_DEPTH;
