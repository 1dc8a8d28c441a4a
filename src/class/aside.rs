//! What makes a student's lab step aside: it then follows the teacher's no more.

use crate::lab::action::{Action, LessonKey};
use crate::lab::command::Command;

/// Whether `action` changes run or page, so that a lab which does it follows no more.
pub(super) fn changes_the_run(action: Action) -> bool {
    use Action as A;
    use LessonKey as Key;
    matches!(
        action,
        A::TogglePause
            | A::GoTo
            | A::GoToCursor
            | A::ChoosePush
            | A::Parameters
            | A::FindValue
            | A::Edit
            | A::Browse
            | A::Lesson(Key::Next | Key::Before | Key::Again | Key::ShowTask | Key::List)
    )
}

/// Whether `command` changes the run, or where it stands.
pub(super) fn commands_the_run(command: &Command) -> bool {
    use Command as C;
    matches!(
        command,
        C::Open(_)
            | C::Set(_)
            | C::Nudge { .. }
            | C::Push(_)
            | C::NextPush(_)
            | C::Step(_)
            | C::GoTo(_)
            | C::RunUntil(_)
            | C::Run
            | C::Pause
            | C::Undo(_)
            | C::Redo(_)
            | C::Speed(_)
            | C::TakeAdvice
    )
}
