//! Folds the branches, switches and loops of a function whose conditions are known.

use super::super::operands;
use super::{Flow, Folder, Known, forget};
use naga::{Block, Expression, Handle, Literal, Span, Statement, SwitchCase, SwitchValue};
use std::collections::HashSet;

impl Folder<'_> {
    /// Folds an `if`: on a constant, it becomes the arm that is taken.
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

    /// Folds a `switch`: on a constant, it becomes the case that is taken, inside a `switch` of its
    /// own if that case breaks from within.
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
                // A case that falls through no longer does so if its folded body ends.
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

    /// Folds a loop: one that never repeats becomes its first iteration, which is often empty.
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
        // The continuing block sees what the body has evaluated.
        let (continuing, _) = self.block(continuing, &mut known.clone());
        self.scope.truncate(outer);
        let break_if = break_if.map(|condition| self.resolve(condition));
        folded.push(Statement::Loop { body, continuing, break_if }, span);
        Flow::GoesOn
    }

    /// Returns the first iteration of a loop if it certainly leaves the loop at its end and nowhere
    /// earlier. It is folded with the values known on entry, which hold for that iteration alone.
    /// If there is another iteration, the trial is undone and the result is `None`.
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

/// Returns the statements that a `switch` runs for a selector: those of its case and of the cases
/// that it falls through to.
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

/// Whether a block breaks out of the switch or loop that contains it.
fn breaks(block: &Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Break => true,
        // A `break` inside these belongs to them.
        Statement::Switch { .. } | Statement::Loop { .. } => false,
        other => operands::blocks(other).into_iter().any(breaks),
    })
}

/// Whether a block continues with the next iteration of the loop that contains it.
fn continues(block: &Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Continue => true,
        // A switch has no iterations, so only a loop ends the search.
        Statement::Loop { .. } => false,
        other => operands::blocks(other).into_iter().any(continues),
    })
}
