//! Journals by themselves.

use super::*;
use crate::scenario::{Document, limits, presets};

fn journal(name: &str) -> Journal {
    Journal::of(Document::open(name).unwrap().scenario().unwrap().file)
}

/// The run of method-2 after these acts, each at its step.
fn after(acts: impl IntoIterator<Item = (u64, Act)>) -> Journal {
    let mut journal = journal("method-2");
    for (step, act) in acts {
        journal.act(step, act, false).unwrap();
    }
    journal
}

fn push(from_s: f64) -> Act {
    Act::Push(pushed(from_s))
}

fn pushed(from_s: f64) -> PushFile {
    PushFile {
        point: "top".to_owned(),
        force_N: [10.0, 0.0, 0.0],
        from_s: Some(from_s),
        for_s: Some(1.0),
        ..PushFile::default()
    }
}

fn gravity(value: f64) -> Act {
    Act::set("motion.gravity_m_per_s2", value.into())
}

fn title(title: &str) -> Act {
    Act::set("title", title.into())
}

fn one(key: &str, value: impl Into<Value>) -> Table {
    Table::from_iter([(key.to_owned(), value.into())])
}

/// The numbers of edits and of pushes in the run file.
fn counts(journal: &Journal) -> (usize, usize) {
    let file = journal.file();
    (file.edit.len(), file.push.len())
}

#[test]
fn an_act_drops_entries_at_later_steps_until_it_is_undone() {
    let mut journal = after([
        (10, gravity(1.0)),
        (50, push(5.0)),
        (60, title("Mine")),
        (20, gravity(2.0)),
    ]);
    assert_eq!(counts(&journal), (2, 0));
    assert_eq!(journal.file().title, "Mine");
    assert_eq!(journal.undo().unwrap().0, 20);
    assert_eq!(counts(&journal), (1, 1));
    journal.redo().unwrap();
    assert_eq!(counts(&journal), (2, 0));
    assert_eq!(journal.later_than(15), 1);
}

#[test]
fn the_run_up_to_a_step_ends_there_and_has_its_description() {
    let mut journal = after([5, 10, 10, 20].map(|step| (step, gravity(step as f64))));
    journal.act(30, push(5.0), false).unwrap();
    journal.act(40, title("Mine"), false).unwrap();
    for (step, edits, pushes) in [
        (0, 0, 0),
        (4, 0, 0),
        (5, 1, 0),
        (10, 2, 0),
        (15, 2, 0),
        (20, 3, 0),
        (30, 3, 1),
        (50, 3, 1),
    ] {
        let run = journal.scenario_until(step).unwrap();
        let found = (run.steps, run.edits.len(), run.pushes.len());
        assert_eq!(found, (step.max(1), edits, pushes));
        assert_eq!(run.file.title, "Mine");
    }
    let begun = journal.begun_with(10, &one("start.tilt_deg", 3.0));
    assert_eq!(begun.unwrap().file.title, "Mine");
}

#[test]
fn an_act_that_passes_a_limit_is_refused() {
    let mut file = journal("method-2").file();
    file.edit = (0..limits::MOST_EDITS as u64)
        .map(|step| EditFile {
            step,
            set: one("motion.gravity_m_per_s2", 1.0),
        })
        .collect();
    let mut journal = Journal::of(file);
    let refusal = |done: Result<_, Problems>| done.map(drop).unwrap_err().in_one_line();
    let edit = journal.act(1_000_000, gravity(2.0), false);
    assert!(refusal(edit).starts_with("edit: 10001 edits are too many: at most 10000"));
    // With the 14 points of method-2 there is room for 86 pushes.
    Arc::make_mut(&mut journal.base).push = vec![pushed(1.0); 86];
    journal.scenario().unwrap();
    let push = journal.act(1_000_000, push(2.0), false);
    assert!(refusal(push).contains("10000 times 101 may be at most 1000000"));
    journal.log.clear();
    Arc::make_mut(&mut journal.base).push = vec![pushed(1.0); limits::MOST_PUSHES];
    let push = journal.act(3, Act::Push(pushed(2.0)), false);
    assert!(refusal(push).starts_with("push: 10001 pushes are too many: at most 10000"));
}

#[test]
fn pushes_added_at_one_step_keep_their_order() {
    let own = "[[push]]\npoint = 'top'\nforce_N = [0, 0, -1]\nfor_s = 1\n".repeat(8);
    let added = "[[edit]]\nstep = 5\nset = { 'push.8' = \
                 { point = 'top', force_N = [0, 0, -1], for_s = 1 } }\n";
    let text = presets::find("method-2").unwrap().text;
    let document = Document::parse("pushed", &format!("{text}\n{own}{added}")).unwrap();
    let mut journal = Journal::of(document.scenario().unwrap().file);
    for count in 10..13 {
        let scenario = journal.act(20, push(2.0), false).unwrap();
        assert_eq!(scenario.edits.last().unwrap().pushes.len(), count);
    }
}

#[test]
fn edits_at_one_step_are_joined_unless_the_file_had_them_apart() {
    let scheme = Act::set("motion.scheme", "rk4".into());
    let journal = after([gravity(1.0), gravity(2.0), scheme].map(|act| (10, act)));
    let mut file = journal.file();
    assert_eq!((file.edit.len(), file.edit[0].set.len()), (1, 2));
    file.edit.push(EditFile {
        step: 10,
        set: one("motion.gravity_m_per_s2", 3.0),
    });
    assert_eq!(Journal::of(file.clone()).file(), file);
}

#[test]
fn a_new_push_keeps_the_numbers_of_pushes_that_edits_added() {
    let mut file = journal("method-2").file();
    let added = "push = { point = 'top', force_N = [0, 1, 0], for_s = 2 }";
    let added = added.parse::<Table>().unwrap();
    file.edit.push(EditFile {
        step: 3,
        set: one("push.0", added["push"].clone()),
    });
    let scenario = Journal::of(file).act(9, push(0.9), false).unwrap();
    let pushes: Vec<_> = scenario
        .edits
        .iter()
        .map(|edit| edit.pushes.len())
        .collect();
    assert_eq!((scenario.pushes.len(), pushes), (0, vec![1, 2]));
}

#[test]
fn a_new_run_begins_with_the_settings_of_the_old_one() {
    let mut journal = journal("wobble-push");
    for (step, act) in [
        (40, Act::set("motion.time_step_s", 0.05.into())),
        (50, push(4.5)),
        (55, Act::set("push.1.force_N.0", 3.0.into())),
        (60, gravity(1.6)),
    ] {
        journal.act(step, act, false).unwrap();
    }
    let begun_at = |step| {
        journal
            .begun_with(step, &one("start.tilt_deg", 10.0))
            .unwrap()
    };
    let scenario = begun_at(60);
    let motion = &scenario.motion;
    assert_eq!((motion.time_step_s, motion.gravity), (0.05, 1.6));
    assert_eq!((scenario.pushes.len(), scenario.edits.len()), (1, 0));
    // The push keeps its times in seconds.
    let push = &scenario.file.push[0];
    assert_eq!((push.from_s, push.for_s), (Some(0.0), Some(20.0)));
    assert_eq!(begun_at(39).motion.time_step_s, 0.1);
}
