//! A picture in parts: each is a file of its own, made anywhere and at any time, and all of them together are the
//! picture.
//!
//! Stands above `render` and `image`, below `cli`. Since every device makes the same bytes, parts need not know of each
//! other: what they are parts of is a hash, the same wherever it is computed.
//!
//! ```text
//! Scene, Settings ─ work ─► Work: rays by rows ─ cut ─► Cut: the rows of each part ─ identity ─► Identity
//!                                                         │
//! render: Bands ─ splitter ─► writer: a part's file, whole or not there (header: its layout)
//!                                                         │
//! a folder of parts ─ folder ─► Survey: which are right, which are not and why ─ join ─► image: PPM, PNG, EXR
//! ```
//!
//! Parts from elsewhere are data: sizes and hashes are checked before anything is allocated for them or copied.

mod cut;
mod folder;
mod header;
mod identity;
mod join;
mod list;
mod part;
mod splitter;
mod work;
mod writer;

pub use cut::{Cut, Uncuttable};
pub use folder::{Folder, State, Survey};
pub use header::{Header, Layout};
pub use identity::{Identity, RULES};
pub use join::{JoinError, Joined, join};
pub use list::list;
pub use part::{Part, PartError};
pub use splitter::Splitter;
pub use work::Work;
pub use writer::PartFile;
