//! Tests of journals alone.

use super::*;
use crate::scenario::file::EditFile;
use crate::scenario::{Document, limits, presets};
use toml::Value;

fn opened_scenario(name: &str) -> Scenario {
    Document::open(name).unwrap().scenario().unwrap()
}

fn journal(name: &str) -> Journal {
    Journal::new(name, &opened_scenario(name))
}

/// Returns the journal of the unchecked `file`.
fn journal_of(file: ScenarioFile) -> Journal {
    let scenario = opened_scenario("method-2");
    Journal::new("edited", &Scenario { file, ..scenario })
}

fn perform(journal: &mut Journal, step: u64, act: Act) -> Result<Arc<Scenario>, Problems> {
    journal.perform(step, vec![act], false)
}

/// Returns the run of method-2 after these acts, each at its step.
fn after(acts: impl IntoIterator<Item = (u64, Act)>) -> Journal {
    let mut journal = journal("method-2");
    for (step, act) in acts {
        perform(&mut journal, step, act).unwrap();
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

fn edit(key: &str, value: impl Into<Value>) -> Act {
    Act::Edit(one(key, value))
}

fn gravity(value: f64) -> Act {
    edit("motion.gravity_m_per_s2", value)
}

fn title(title: &str) -> Act {
    Act::Metadata(one("title", title))
}

fn one(key: &str, value: impl Into<Value>) -> Table {
    Table::from_iter([(key.to_owned(), value.into())])
}

/// Returns the numbers of edits and of pushes in the run file.
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
    assert_eq!(journal.undo()[0].step, 20);
    assert_eq!(counts(&journal), (1, 1));
    journal.redo();
    assert_eq!(counts(&journal), (2, 0));
    assert_eq!(journal.later_than(15), 1);
}

#[test]
fn a_run_up_to_a_step_ends_there_and_keeps_its_title() {
    let mut journal = after([5, 10, 10, 20].map(|step| (step, gravity(step as f64))));
    perform(&mut journal, 30, push(5.0)).unwrap();
    perform(&mut journal, 40, title("Mine")).unwrap();
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
fn acts_beyond_a_limit_are_rejected() {
    let mut file = journal("method-2").file();
    file.edit = (0..limits::MOST_EDITS as u64)
        .map(|step| EditFile {
            step,
            set: one("motion.gravity_m_per_s2", 1.0),
        })
        .collect();
    let refusal = |edited: &ScenarioFile, step, act| {
        let refused = perform(&mut journal_of(edited.clone()), step, act);
        refused.unwrap_err().in_one_line()
    };
    let edits = refusal(&file, 1_000_000, gravity(2.0));
    assert!(edits.starts_with("edit: 10001 edits are too many: at most 10000"));
    // With the 14 points of method-2 there is room for 86 pushes.
    file.push = vec![pushed(1.0); 86];
    journal_of(file.clone()).scenario().unwrap();
    let both = refusal(&file, 1_000_000, push(2.0));
    assert!(both.contains("10000 times 101 may be at most 1000000"));
    file.edit.clear();
    file.push = vec![pushed(1.0); limits::MOST_PUSHES];
    let pushes = refusal(&file, 3, push(2.0));
    assert!(pushes.starts_with("push: 10001 pushes are too many: at most 10000"));
}

#[test]
fn pushes_added_at_one_step_keep_their_order() {
    let own = "[[push]]\npoint = 'top'\nforce_N = [0, 0, -1]\nfor_s = 1\n".repeat(8);
    let added = "[[edit]]\nstep = 5\nset = { 'push.8' = \
                 { point = 'top', force_N = [0, 0, -1], for_s = 1 } }\n";
    let text = presets::find("method-2").unwrap().text;
    let document = Document::parse("pushed", &format!("{text}\n{own}{added}")).unwrap();
    let mut journal = Journal::new("pushed", &document.scenario().unwrap());
    for count in 10..13 {
        let scenario = perform(&mut journal, 20, push(2.0)).unwrap();
        assert_eq!(scenario.edits.last().unwrap().pushes.len(), count);
    }
}

#[test]
fn edits_at_one_step_are_merged_unless_the_file_separates_them() {
    let scheme = edit("motion.scheme", "rk4");
    let journal = after([gravity(1.0), gravity(2.0), scheme].map(|act| (10, act)));
    let mut file = journal.file();
    assert_eq!((file.edit.len(), file.edit[0].set.len()), (1, 2));
    file.edit.push(EditFile {
        step: 10,
        set: one("motion.gravity_m_per_s2", 3.0),
    });
    assert_eq!(journal_of(file.clone()).file(), file);
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
    let scenario = perform(&mut journal_of(file), 9, push(0.9)).unwrap();
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
        (40, edit("motion.time_step_s", 0.05)),
        (50, push(4.5)),
        (55, edit("push.1.force_N.0", 3.0)),
        (60, gravity(1.6)),
    ] {
        perform(&mut journal, step, act).unwrap();
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

fn leave(journal: &mut Journal, step: u64) {
    journal.set_left_at(step, &NextPush::suggested_for(&opened_scenario("method-2")));
}

fn begin_with_tilt(journal: &mut Journal, left_at: u64, tilt_deg: f64, coalesces: bool) {
    leave(journal, left_at);
    let set = one("start.tilt_deg", tilt_deg);
    journal.begin_with(&set, Vec::new(), coalesces).unwrap();
}

fn set(journal: &mut Journal, step: u64, key: &str, value: f64) -> Arc<Scenario> {
    perform(journal, step, edit(key, value)).unwrap()
}

fn time_step(journal: &Journal) -> f64 {
    let scenario = journal.scenario().unwrap();
    let edit = scenario.edits.last();
    edit.map_or(scenario.motion, |edit| edit.motion).time_step_s
}

/// Returns the step at which the user left the present run, and its start tilt.
fn place(journal: &Journal) -> (u64, Option<f64>) {
    (journal.present().left_at, journal.file().start.tilt_deg)
}

/// Undoes an edit of the same run and returns its step. Returns `None` if a whole run was undone.
fn undone(journal: &mut Journal) -> Option<u64> {
    let first = &journal.undo()[0];
    first.run().is_none().then_some(first.step)
}

#[test]
fn undo_and_redo_traverse_all_acts_and_runs_in_order() {
    let mut journal = self::journal("method-2");
    set(&mut journal, 40, "motion.time_step_s", 0.05);
    begin_with_tilt(&mut journal, 90, 30.0, false);
    set(&mut journal, 7, "motion.time_step_s", 0.02);
    leave(&mut journal, 9);
    journal.begin("cusps", &opened_scenario("cusps"));
    assert_eq!(undone(&mut journal), None);
    assert_eq!(place(&journal), (9, Some(30.0)));
    assert_eq!(undone(&mut journal), Some(7));
    // The new run has the settings that the old one had when it was left.
    assert_eq!(time_step(&journal), 0.05);
    assert_eq!(undone(&mut journal), None);
    assert_eq!(place(&journal), (90, Some(45.0)));
    assert_eq!(undone(&mut journal), Some(40));
    assert!(journal.undo().is_empty());
    for _ in 0..4 {
        assert!(!journal.redo().is_empty());
    }
    assert!(journal.redo().is_empty());
    assert_eq!(journal.present().name, "cusps");
}

#[test]
fn undo_reverts_an_advice_before_the_edits_it_kept() {
    let mut journal = self::journal("method-2");
    let edited = set(&mut journal, 40, "motion.gravity_m_per_s2", 5.0);
    leave(&mut journal, 90);
    journal.begin_again(&edited);
    set(&mut journal, 7, "motion.time_step_s", 0.02);
    assert_eq!(undone(&mut journal), Some(7));
    assert_eq!(undone(&mut journal), None);
    assert_eq!(journal.present().left_at, 90);
    assert_eq!(undone(&mut journal), Some(40));
    for _ in 0..3 {
        assert!(!journal.redo().is_empty());
    }
    assert!(time_step(&journal) == 0.02);
}

#[test]
fn a_new_act_clears_redo() {
    let mut journal = self::journal("method-2");
    begin_with_tilt(&mut journal, 90, 30.0, false);
    journal.undo();
    set(&mut journal, 5, "motion.gravity_m_per_s2", 1.0);
    assert!(journal.redo().is_empty());
}

#[test]
fn a_repeated_nudge_replaces_the_run() {
    let mut journal = self::journal("method-2");
    begin_with_tilt(&mut journal, 90, 30.0, false);
    begin_with_tilt(&mut journal, 5, 31.0, true);
    begin_with_tilt(&mut journal, 5, 32.0, true);
    assert_eq!(place(&journal).1, Some(32.0));
    assert_eq!(undone(&mut journal), None);
    assert_eq!(place(&journal), (90, Some(45.0)));
    assert!(journal.undo().is_empty());
}

fn earlier_runs(journal: &Journal) -> usize {
    let runs = journal.entries.iter().filter_map(|entry| entry.run());
    runs.count()
}

#[test]
fn earlier_runs_are_limited_by_their_total_points() {
    let points = |count: usize| {
        let mut scenario = opened_scenario("method-2");
        let top = scenario.file.body.point[0].clone();
        scenario.file.body.point = vec![top; count];
        scenario
    };
    let mut journal = self::journal("method-2");
    for count in [10, 10, MOST_HISTORY_POINTS - 20, 1] {
        journal.begin("x", &points(count));
    }
    assert_eq!(earlier_runs(&journal), 3, "method-2 went");
    journal.begin("x", &points(1));
    assert_eq!(earlier_runs(&journal), 3, "the first with ten points went");
}

#[test]
fn several_acts_succeed_or_fail_together() {
    let mut journal = self::journal("method-2");
    let before = journal.clone();
    let wrong = vec![gravity(5.0), edit("motion.time_step_s", -1.0)];
    assert!(journal.perform(40, wrong, false).is_err());
    assert_eq!(journal, before);
    let both = Act::set(
        [one("title", "Mine"), one("motion.time_step_s", 0.05)]
            .into_iter()
            .flatten()
            .collect(),
    );
    assert_eq!(both.len(), 2);
    journal.perform(40, both, false).unwrap();
    assert_eq!(journal.undo().len(), 2);
    assert_eq!(journal.file(), before.file());
    assert!(journal.undo().is_empty());
}
