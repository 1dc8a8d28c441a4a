//! Tasks of lessons, done with the keys named on their pages on a screen of 80x24, always with the run in view. Right keys
//! complete the task; after wrong keys, the page is still open and offers a hint.

use crate::support::stage::{SMALL, Stage};
use gyrolab::lab::sheet::{Paragraph, SheetLineKind};
use gyrolab::lab::view::Pane;
use gyrolab::lessons::{opening, shipped};
use gyrolab::tui::screen;

/// A task, the keys that complete it, and keys that do not. A space starts the run if it does not start by itself.
struct PlayedTask {
    lesson: &'static str,
    page: usize,
    right: &'static [&'static str],
    wrong: [&'static str; 2],
}

const fn played(
    lesson: &'static str,
    page: usize,
    right: &'static [&'static str],
    wrong: [&'static str; 2],
) -> PlayedTask {
    PlayedTask {
        lesson,
        page,
        right,
        wrong,
    }
}

/// ⎋ stands for Esc.
#[rustfmt::skip]
const TASKS: [PlayedTask; 18] = [
    played("a-real-gyroscope", 3, &["/moments↓↓\n0.0037516\n⎋"], ["/moments↓↓\n0.0039\n⎋", "/moments\n0.0037516\n⎋"]),
    played("a-real-gyroscope", 6, &["/moments↓↓\n0.003736\n⎋"], ["/moments↓↓\n0.0039\n⎋", "/spin\n600\n⎋"]),
    played("cusps-loops-and-waves", 9, &["/Ly\n2.95\n⎋"], ["/Ly\n1\n⎋", "/Lz\n30\n⎋"]),
    played("does-a-faster-spin-precess-faster", 6, &["/Lz body\n265\n⎋"], ["/Lz body\n500\n⎋", "/gravity\n4\n⎋"]),
    played("does-steeper-precess-faster", 8, &["/gravity\n19.6\n⎋", "rP\n32.667\n↓↓\n20\np ", "/rim height\n2\n⎋"], ["/gravity\n15\n⎋", "/tilt\n60\n⎋"]),
    played("halve-the-step", 9, &["/dt\n0.0016\n⎋"], ["/dt\n0.005\n⎋", "/dt\n0.001\n⎋"]),
    played("is-the-wobble-real", 9, &["/Lz body\n75\n/dt\n0.002\n⎋", "/dt\n0.001\n/Lz body\n80\n⎋"], ["/Lz body\n75\n⎋", "/Lz body\n200\n/dt\n0.002\n⎋"]),
    played("kappa-and-the-scheme", 9, &["/scheme\nstrang\n⎋", "/dt\n0.00001\n⎋"], ["/dt\n0.002\n⎋", "/rim height\n0.5657\n⎋"]),
    played("method-1-and-its-z", 8, &["/Lx\n175\n⎋"], ["/Lx\n350\n⎋", "/Lz\n1000\n⎋"]),
    played("method-2-and-its-straight-line", 9, &["/dt\n0.05\n⎋"], ["/dt\n0.04\n⎋", "/dt\n0.01\n⎋"]),
    played("one-step-by-hand", 8, &["/dt\n0.01\n⎋1g", "/gravity\n98\n⎋1g", "/mass each\n5\n⎋1g"], ["/dt\n0.1\n⎋1g", "/Lz\n10000\n⎋1g"]),
    played("the-sleeping-top-wakes", 8, &["/rim height\n0.9\n⎋", "/gravity\n8\n⎋"], ["/gravity\n9.5\n⎋", "/tilt\n0\n⎋"]),
    played("the-wheel-one-carries", 10, &["P\n5.55\n↓↓\n4\np "], ["P\n11\n↓↓\n4\np ", " "]),
    played("what-holds-the-weight-up", 9, &["P\n11\n↓↓\n20\np ", "/gravity\n12\n⎋ "], ["P\n30\n↓↓\n20\np ", "/mass\n0.6\n⎋ "]),
    played("what-is-conserved", 9, &["/scheme\nstrang\n⎋"], ["/dt\n0.001\n⎋", "/scheme\nrk4\n⎋"]),
    played("which-way-does-your-phone-tumble", 5, &["/wx\n0.3\n/wz\n8\n⎋300g", "/wx\n0.3\n/wy\n8\n⎋300g"], ["/wx\n6\n⎋300g", "300g"]),
    played("why-it-does-not-fall", 8, &["P\n32.667\n↓\nup\n↓\n10\np "], ["P\n20\n↓\nup\n↓\n10\np ", "P\n32.667\n↓↓\n10\np "]),
    played("why-it-seems-to-stand-still", 7, &["g57 s\n"], ["g10 s\n", "/dt\n0.1\n⎋g57 s\n"]),
];

/// Opens the task on `page` of a lesson.
fn task(lesson: &str, page: usize) -> Stage {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.lesson(lesson, page).settle();
    assert!(!is_reached(&stage), "{lesson} {page}");
    stage
}

/// Presses `keys` and asserts after each key that page and run are visible.
#[track_caller]
fn press(stage: &mut Stage, keys: &str) {
    for key in keys.chars() {
        stage.press(&key.to_string().replace('⎋', "\u{1b}"));
        let layout = screen::layout(&stage.lab, true, stage.size);
        let runs = [Pane::Traces, Pane::Above, Pane::ThreeD, Pane::Step];
        let has = |pane| layout.place_of(pane).is_some();
        // The values pane replaces the step pane.
        let is_seen = runs.into_iter().any(has) || stage.lab.view().look.show.contains(&Pane::Step);
        assert!(
            has(Pane::Lesson) && is_seen,
            "{key:?} hides a pane:\n{}",
            stage.picture()
        );
    }
}

/// True if every goal of the page is reached.
fn is_reached(stage: &Stage) -> bool {
    let sheet = stage.lab.view().sheet.as_ref().unwrap();
    let mut goals = sheet
        .paragraphs
        .iter()
        .filter(|one| matches!(one.kind, SheetLineKind::Goal { .. }))
        .peekable();
    goals.peek().is_some()
        && goals.all(|goal| goal.kind == SheetLineKind::Goal { is_reached: true })
}

/// Continues the run for up to 15 seconds of wall time, and lets seeks finish. Returns true if the task is done.
fn run_until_done(stage: &mut Stage) -> bool {
    for _ in 0..150 {
        stage.wait(0.1);
        while stage.lab.player().steps_to_go().is_some() {
            stage.wait(0.0);
        }
        if is_reached(stage) {
            return true;
        }
        if !stage.lab.player().is_running() && stage.lab.script().is_done() {
            stage.wait(0.2);
            return is_reached(stage);
        }
    }
    false
}

#[test]
fn every_task_of_a_lesson_is_tested() {
    let mut on_pages = Vec::new();
    for lesson in shipped::LESSONS {
        let pages = opening::open(lesson.name).unwrap().pages;
        let with_task = pages.iter().filter(|page| page.task().is_some());
        on_pages.extend(with_task.map(|page| (lesson.name, page.number)));
    }
    on_pages.sort_unstable();
    let in_table = TASKS.iter().map(|task| (task.lesson, task.page));
    assert_eq!(in_table.collect::<Vec<_>>(), on_pages);
}

#[test]
fn the_keys_named_on_a_page_complete_its_task() {
    for played in &TASKS {
        for keys in played.right {
            let mut stage = task(played.lesson, played.page);
            press(&mut stage, keys);
            let place = format!("{} {}: {keys:?}", played.lesson, played.page);
            assert!(run_until_done(&mut stage), "{place}\n{}", stage.picture());
            stage.shows("[x] done");
        }
    }
}

#[test]
fn wrong_keys_leave_the_task_open_with_a_hint() {
    for played in &TASKS {
        for keys in played.wrong {
            let mut stage = task(played.lesson, played.page);
            press(&mut stage, keys);
            let place = format!("{} {}: {keys:?}", played.lesson, played.page);
            assert!(!run_until_done(&mut stage), "{place}\n{}", stage.picture());
            let open = stage.class.open_lesson().unwrap();
            assert_eq!(open.place.page, played.page, "{place}");
            assert!(open.place.tasks.is_empty(), "{place}");
            press(&mut stage, "h");
            let sheet = stage.lab.view().sheet.clone().unwrap();
            let mut hints = sheet.paragraphs.iter().map(Paragraph::text);
            assert!(hints.any(|text| text.starts_with("Hint: ")), "{place}");
        }
    }
}

#[test]
fn a_completed_task_stays_completed_while_its_list_shows_the_current_run() {
    let mut stage = task("method-1-and-its-z", 8);
    press(&mut stage, "/Lx\n175\n⎋");
    assert!(run_until_done(&mut stage));
    stage.shows("[x] done").shows("[x] t is 0.05 s or more");
    press(&mut stage, "/Lx\n350\n⎋");
    assert!(!run_until_done(&mut stage));
    stage.shows("[x] done before, with highest tilt =");
    stage.shows("[ ] highest tilt off 10 degrees");
}

#[test]
fn no_page_asks_for_a_restart_after_an_edit() {
    for lesson in shipped::LESSONS {
        let words = lesson.text.split_whitespace().collect::<Vec<_>>().join(" ");
        for asked in ["`r` first", "press `r`", "then `r`", "`r`, then"] {
            assert!(!words.contains(asked), "{}: {asked}", lesson.name);
        }
    }
}
