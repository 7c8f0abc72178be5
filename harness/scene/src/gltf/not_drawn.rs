//! What the loader reads and no renderer draws yet. A renderer that learns to draw one of these takes
//! it from its list, and files are no longer said to lack it.

use crate::TextureSlot;

/// Textures that are loaded and not drawn: their factor is drawn alone.
pub(super) const TEXTURES: &[TextureSlot] = &[TextureSlot::Transmission];
