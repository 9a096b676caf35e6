//! How the picture of a session is rendered, which its file does not say.

use std::sync::Arc;

use super::Session;
use crate::preview::rendering::Rendering;

impl Session {
    /// How the picture is rendered.
    pub(in crate::preview) fn rendering(&self) -> Rendering {
        self.rendering
    }

    /// Renders otherwise, if that can be; why not is said. Whether there is something else to be rendered.
    pub(in crate::preview) fn render_as(&mut self, rendering: Rendering) -> bool {
        let width = self
            .wanted()
            .map_or(1, |(scene, _)| scene.camera.pixeldim[0]);
        if let Some(fault) = rendering.fault(width) {
            self.said.push(fault);
            return false;
        }
        let before = std::mem::replace(&mut self.rendering, rendering);
        before != rendering
    }

    /// The text of the last good version.
    pub(in crate::preview) fn text(&self) -> Option<&Arc<Vec<u8>>> {
        self.good.as_ref().map(|(_, text)| text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preview::session::{News, Version};
    use crate::settings::{MAX_SAMPLES, SamplePattern};

    #[test]
    fn what_takes_too_much_memory_is_refused_and_said() {
        let mut session = Session::new("a.txt".into(), None);
        let scene = "camera cam { pixeldim 640 48 worlddim 8 6 viewpoint 4 3 6 }";
        session.news(News::Version(Version::read("a.txt".as_ref(), scene.into())));
        let course = Rendering {
            samples: 16,
            jitter: SamplePattern::Course,
            ..Rendering::default()
        };
        assert!(session.render_as(course));
        assert!(!session.render_as(course));
        let many = Rendering {
            samples: MAX_SAMPLES,
            ..course
        };
        assert!(!session.render_as(many));
        assert_eq!(session.rendering(), course);
        assert!(
            session.said[0].contains("65536 samples"),
            "{:?}",
            session.said
        );
    }
}
