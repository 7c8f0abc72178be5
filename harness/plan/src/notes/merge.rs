//! One note for all objects of which it says the same.

use crate::Note;

/// Adds a note on one object; merges it with an earlier note on other objects if both say the same.
pub(super) fn add(notes: &mut Vec<Note>, note: Note) {
    let known = notes.iter_mut().find_map(|known| match (known, &note) {
        (Note::NotSolid { objects, rung, .. }, Note::NotSolid { rung: other, .. }) if rung == other => Some(objects),
        (Note::InsideOut { objects }, Note::InsideOut { .. })
        | (Note::NoArea { objects }, Note::NoArea { .. })
        | (Note::BackNotDrawn { objects }, Note::BackNotDrawn { .. })
        | (Note::Black { objects, .. }, Note::Black { .. })
        | (Note::ClipsToWhite { objects, .. }, Note::ClipsToWhite { .. }) => Some(objects),
        (Note::ThinWall { objects, unused }, Note::ThinWall { unused: other, .. }) if unused == other => Some(objects),
        (Note::HardEdges { objects, rung }, Note::HardEdges { rung: other, .. }) if rung == other => Some(objects),
        (Note::FactorsAlone { objects, rung, what }, Note::FactorsAlone { rung: other, what: others, .. })
            if rung == other && what == others =>
        {
            Some(objects)
        }
        (Note::NotClear { objects, instead, .. }, Note::NotClear { instead: other, .. }) if instead == other => {
            Some(objects)
        }
        (Note::AllEnters { objects, rung, share }, Note::AllEnters { rung: other, share: others, .. })
            if (*rung, *share) == (*other, *others) =>
        {
            Some(objects)
        }
        (Note::LampInside { objects, rung }, Note::LampInside { rung: other, .. })
        | (Note::LightsNotSeen { objects, rung }, Note::LightsNotSeen { rung: other, .. })
            if rung == other =>
        {
            Some(objects)
        }
        (Note::OthersNotSeen { objects, rung, share }, Note::OthersNotSeen { rung: other, share: another, .. })
            if rung == other =>
        {
            *share = share.max(*another);
            Some(objects)
        }
        (Note::TooDeep { objects, within, rung }, Note::TooDeep { rung: other, within: others, .. })
            if rung == other =>
        {
            *within = (*within).max(*others);
            Some(objects)
        }
        (Note::PolishedAndClear { objects, rung, what }, Note::PolishedAndClear { rung: other, what: others, .. })
            if rung == other && what == others =>
        {
            Some(objects)
        }
        (
            Note::ShareSpace { objects, with, there, rung, shown },
            Note::ShareSpace { with: others, there: here, rung: other, shown: also, .. },
        ) if rung == other && with == others && there == here && shown == also => Some(objects),
        (Note::Within { objects, around, rung }, Note::Within { around: others, rung: other, .. })
            if rung == other && around == others =>
        {
            Some(objects)
        }
        (Note::OtherColor { objects, color }, Note::OtherColor { color: other, .. }) if color == other => Some(objects),
        _ => None,
    });
    match known {
        Some(objects) => objects.count += 1,
        None => notes.push(note),
    }
}
