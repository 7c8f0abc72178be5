//! The branches, switches and loops of a function, folded where what they depend on is known.

use super::super::operands;
use super::{Flow, Folder, Known, forget};
use naga::{Block, Expression, Handle, Literal, Span, Statement, SwitchCase, SwitchValue};
use std::collections::HashSet;

impl Folder<'_> {
    /// An `if` on a constant becomes the arm that is taken.
    pub(super) fn branch(
        &mut self,
        condition: Handle<Expression>,
        [accept, reject]: [Block; 2],
        span: Span,
        known: &mut Known,
        folded: &mut Block,
    ) -> Flow {
        if let Some(condition) = self.boolean(condition) {
            let (mut taken, flow) = self.block(if condition { accept } else { reject }, known);
            folded.append(&mut taken);
            return flow;
        }
        let mut known_in_reject = known.clone();
        let (accept, accept_flow) = self.inner_block(accept, known);
        let (reject, reject_flow) = self.inner_block(reject, &mut known_in_reject);
        folded.push(Statement::If { condition, accept, reject }, span);
        match (accept_flow, reject_flow) {
            (Flow::Ends, Flow::Ends) => return Flow::Ends,
            (Flow::Ends, Flow::GoesOn) => *known = known_in_reject,
            (Flow::GoesOn, Flow::Ends) => {}
            (Flow::GoesOn, Flow::GoesOn) => {
                known.retain(|local, held| known_in_reject.get(local).is_some_and(|other| held.is(*other)));
            }
        }
        Flow::GoesOn
    }

    /// A `switch` on a constant becomes the case that is taken, in a `switch` of its own where it breaks from within.
    pub(super) fn switch(
        &mut self,
        selector: Handle<Expression>,
        cases: Vec<SwitchCase>,
        span: Span,
        known: &mut Known,
        folded: &mut Block,
    ) -> Flow {
        let mut written = HashSet::new();
        cases.iter().for_each(|case| self.written_in(&case.body, &mut written));
        let Some(selected) = self.scalar(selector) else {
            let mut known_behind = known.clone();
            forget(&mut known_behind, &written);
            let mut entered_from_above = false;
            let mut folded_cases = Vec::with_capacity(cases.len());
            for SwitchCase { value, body, fall_through } in cases {
                let mut known_in_case = if entered_from_above { known_behind.clone() } else { known.clone() };
                let (body, flow) = self.inner_block(body, &mut known_in_case);
                // A case that was to fall through and now ends, ends.
                let fall_through = fall_through && flow == Flow::GoesOn;
                // `case 1, 2` falls through from an empty case, which changes nothing.
                entered_from_above = fall_through && !body.is_empty();
                folded_cases.push(SwitchCase { value, body, fall_through });
            }
            folded.push(Statement::Switch { selector, cases: folded_cases }, span);
            *known = known_behind;
            return Flow::GoesOn;
        };
        let mut known_inside = known.clone();
        let outer = self.scope.len();
        let (mut taken, mut flow) = self.block(taken_case(cases, selected), &mut known_inside);
        if matches!(taken.last(), Some(Statement::Break)) {
            taken.cull(taken.len() - 1..);
            flow = Flow::GoesOn;
        }
        if breaks(&taken) {
            self.scope.truncate(outer);
            forget(known, &written);
            let case = SwitchCase { value: SwitchValue::Default, body: taken, fall_through: false };
            folded.push(Statement::Switch { selector, cases: vec![case] }, span);
            return Flow::GoesOn;
        }
        *known = known_inside;
        folded.append(&mut taken);
        flow
    }

    /// A loop that never comes round becomes its first round, often nothing.
    pub(super) fn repeat(
        &mut self,
        body: Block,
        continuing: Block,
        break_if: Option<Handle<Expression>>,
        span: Span,
        known: &mut Known,
        folded: &mut Block,
    ) -> Flow {
        if let Some((mut only_round, flow)) = self.only_round(&body, known) {
            folded.append(&mut only_round);
            return flow;
        }
        let mut written = HashSet::new();
        self.written_in(&body, &mut written);
        self.written_in(&continuing, &mut written);
        forget(known, &written);
        let outer = self.scope.len();
        let (body, _) = self.block(body, &mut known.clone());
        // It sees what the body has evaluated.
        let (continuing, _) = self.block(continuing, &mut known.clone());
        self.scope.truncate(outer);
        let break_if = break_if.map(|condition| self.resolve(condition));
        folded.push(Statement::Loop { body, continuing, break_if }, span);
        Flow::GoesOn
    }

    /// The first round of a loop, where it certainly leaves the loop at its end and nowhere before: folded with what is
    /// known on entry, which holds for that round alone. Where there is another, nothing of the trial is kept.
    fn only_round(&mut self, body: &Block, known: &mut Known) -> Option<(Block, Flow)> {
        let before = (self.expressions.clone(), self.stands_for.clone(), self.scope.len());
        let mut known_inside = known.clone();
        let (mut round, _) = self.block(body.clone(), &mut known_inside);
        let flow = match round.last() {
            Some(Statement::Break) => {
                round.cull(round.len() - 1..);
                Some(Flow::GoesOn)
            }
            Some(Statement::Return { .. } | Statement::Kill) => Some(Flow::Ends),
            _ => None,
        };
        match flow {
            Some(flow) if !breaks(&round) && !continues(&round) => {
                *known = known_inside;
                Some((round, flow))
            }
            _ => {
                (*self.expressions, self.stands_for) = (before.0, before.1);
                self.scope.truncate(before.2);
                None
            }
        }
    }
}

/// The statements that a `switch` runs for a selector: a case's, and those that it falls through to.
fn taken_case(cases: Vec<SwitchCase>, selected: Literal) -> Block {
    let is_selected = |case: &SwitchCase| match (case.value, selected) {
        (SwitchValue::I32(value), Literal::I32(selected)) => value == selected,
        (SwitchValue::U32(value), Literal::U32(selected)) => value == selected,
        _ => false,
    };
    let is_default = |case: &SwitchCase| case.value == SwitchValue::Default;
    let first = cases.iter().position(is_selected).or_else(|| cases.iter().position(is_default));
    let mut taken = Block::new();
    for mut case in cases.into_iter().skip(first.expect("a valid switch has a default case")) {
        taken.append(&mut case.body);
        if !case.fall_through {
            break;
        }
    }
    taken
}

/// Whether a block breaks out of the switch or loop that it stands in.
fn breaks(block: &Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Break => true,
        // A break inside these is theirs.
        Statement::Switch { .. } | Statement::Loop { .. } => false,
        other => operands::blocks(other).into_iter().any(breaks),
    })
}

/// Whether a block goes on to the next round of the loop that it stands in.
fn continues(block: &Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Continue => true,
        // A switch has no rounds.
        Statement::Loop { .. } => false,
        other => operands::blocks(other).into_iter().any(continues),
    })
}
