//! The header of a live session: what a page needs before the first frame.

use tumble_io::page::Header;

use crate::Session;
use crate::integrators::integrators;
use crate::parameters::parameters;

/// The header as JSON, in the format of `motion.html`, with the lists of sliders and integrators.
pub fn json(session: &Session) -> String {
    let mut header = Header::new(session.scene(), session.world());
    header.live = true;
    header.parameters = parameters(session.next_scene());
    header.integrators = integrators(session.scene(), session.world());
    header.to_json()
}
