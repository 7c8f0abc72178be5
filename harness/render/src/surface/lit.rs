//! What lights a body that is shaded at its surface, as its pipelines bind it.

use crate::error::RenderError;
use crate::frame::{Bound, Builder, PipelineId};
use crate::light::lighting::Lighting;
use crate::shadow::shadows::Shadows;

/// The lighting of the objects, and the shadows; `None` if there are none.
pub(crate) type Light<'a> = (&'a Lighting<'a>, Option<&'a Shadows>);

/// Returns the resources of group 0 that the pipeline reads, besides the view.
pub(crate) fn shared(
    builder: &mut Builder<'_>,
    (lighting, shadows): Light<'_>,
    pipeline: PipelineId,
) -> Result<Vec<(u32, Bound)>, RenderError> {
    let mut shared = lighting.shared(builder, pipeline)?;
    shared.extend(shadows.into_iter().flat_map(|shadows| shadows.shared(builder, pipeline)));
    Ok(shared)
}
