//! Texts of the lab from the viewpoint of a new user.

use crate::support::scenarios::preset;
use crate::support::stage::{LARGE, SMALL, Stage};
use crate::support::words::{has, has_no};
use gyrolab::lab::browser::Browser;
use gyrolab::tui::keymap::Key;
use ratatui::layout::Rect;
use std::path::Path;

#[test]
fn esc_returns_from_the_values_to_the_run() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    for key in ["e", "P"] {
        stage.press(key);
        assert_eq!(stage.focus(), "parameters", "{key}");
        while stage.focus() == "parameters" {
            stage.shows_no("nothing to close");
            stage.key(Key::Esc);
        }
        assert_eq!(stage.focus(), "traces", "{key}");
    }
    stage.key(Key::Esc);
    stage.shows("nothing to close; q quits");
}

#[test]
fn changes_to_a_preset_are_listed_like_those_to_a_file() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.press("p.");
    stage.shows("differs from the preset method-2: one more push");
    let mut cusps = Stage::open("cusps", &[], SMALL);
    cusps.commands("set = { 'friction.swing_viscous_Nms' = 0.1 }");
    cusps.shows("differs from the preset cusps: friction.swing_viscous_Nms 0.1");
}

/// The texts of a preset describe its own motion, not that of a run derived from it.
#[test]
fn texts_about_another_motion_are_marked_in_saved_files() {
    let folder = tempfile::tempdir().unwrap();
    let mut stage = Stage::open("fast-top", &[], SMALL);
    stage.lab.files_mut().work_in(folder.path());
    stage.commands("save = { path = 'own.toml', to_step = 9 }");
    stage.commands(
        "set = { 'start.momentum_Js.2' = 1000 }\nsave = { path = 'changed.toml', to_step = 9 }",
    );
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let own = read("own.toml");
    has(&own, "look_at = \"Precession of 5.6");
    let changed = read("changed.toml");
    let difference =
        "differs from the preset fast-top: start.momentum_Js [0, 0, 1000], not [0, 0, 500]";
    has(&changed, format!("look_at = \"{difference}\""));
    has(&changed, "Of the preset fast-top as it was: L is so large");
    has(&changed, "; changed since");
    has_no(&changed, "5.6 degrees");
    let path = folder.path().join("changed.toml");
    let mut reopened = Stage::open(path.to_str().unwrap(), &[], SMALL);
    reopened.shows("start.momentum_Js [0, 0, 1000], not [0, 0,");
    // Changed and saved again, the text is marked only once.
    reopened.lab.files_mut().work_in(folder.path());
    reopened.commands(
        "set = { 'motion.gravity_m_per_s2' = 5 }\nsave = { path = 'again.toml', to_step = 9 }",
    );
    let again = read("again.toml");
    assert!(again.contains("look_at = \"differs from changed.toml: gravity 5 m/s2, not 9.8\""));
    let begin = "Of the preset fast-top as it was: L is";
    assert!(
        ['\n', '"']
            .iter()
            .any(|c| again.contains(&format!("{c}{begin}")))
    );
}

/// `run --set` copies the texts of the file.
#[test]
fn texts_of_a_preset_are_recognized_in_files_of_another_motion() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.toml");
    let changed = preset("fast-top", &["start.momentum_Js=[0,0,1000]"]);
    std::fs::write(&path, changed.to_toml()).unwrap();
    Stage::open(path.to_str().unwrap(), &[], SMALL)
        .shows("differs from the preset fast-top: start.momentum_Js [0, 0, 1000]")
        .shows_no("5.6 degrees");
    std::fs::write(&path, preset("fast-top", &["motion.steps=9"]).to_toml()).unwrap();
    Stage::open(path.to_str().unwrap(), &[], SMALL).shows("5.6 degrees");
}

#[test]
fn keys_without_a_visible_effect_show_a_message() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.commands("pause = true\ngo_to = 100");
    // Arrow keys act on the pane in focus, or say which keys do.
    stage.press("\t↓").shows("z and Z zoom here");
    // The first jump beyond the end is reported, a later one is not.
    stage.press("g2400\n").wait(2.0);
    stage.shows("step 2,400 is beyond the end of the run, step 2,300");
    stage.press("g2350\n").wait(0.5);
    stage.shows_no("is beyond the end");
}

#[test]
fn the_suggested_next_step_is_not_done_already() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.commands("pause = true\ngo_to = 2290\nrun = true");
    stage.wait(2.0);
    stage.shows("Next: t draws the exact motion");
    let mut drawn = Stage::open("method-2", &[], LARGE);
    drawn.commands("pause = true\nexact = true\ngo_to = 2290\nrun = true");
    drawn.wait(2.0);
    drawn.shows("Next: the exact motion is drawn in dashes");
    drawn.shows_no("t draws");
}

#[test]
fn a_small_screen_shows_a_long_message_and_a_warning() {
    let mut stage = Stage::open("method-2", &[], Rect::new(0, 0, 40, 12));
    stage.commands("pause = true\ngo_to = 100");
    stage.shows("NOT RELIABLE").press("e");
    stage.shows("Up, Down choose a value; Left, Right");
    stage.shows("nudge it; Enter types it; u undoes");
    stage.shows("NOT RELIABLE");
    stage.wait(6.0).shows_no("nudge it").shows("NOT RELIABLE");
}

#[test]
fn esc_closes_full_screen_values() {
    let mut stage = Stage::open("method-2", &[], Rect::new(0, 0, 40, 12));
    stage.press("e").shows(" values ").press("\u{1b}");
    assert_eq!(stage.focus(), "traces");
    stage.shows_no(" values ");
}

/// The clock also distinguishes the shorter steps before an edit.
#[test]
fn the_clock_has_enough_digits_for_the_shortest_step() {
    let mut stage = Stage::open("cusps", &[], SMALL);
    stage.commands("pause = true\ngo_to = 1468").wait(0.5);
    stage.shows("t  1.468 s");
    stage.commands("set = { \"motion.time_step_s\" = 5 }");
    stage.wait(0.5);
    stage.shows("t     1.468 s");
}

#[test]
fn esc_returns_from_a_found_value_to_the_page() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.lesson("does-a-faster-spin-precess-faster", 6);
    stage.settle();
    stage.press("/Lz body\n300\n").settle();
    stage.shows("to the page").press("\u{1b}");
    stage.shows("Your turn").shows_no("to the page");
}

#[test]
fn esc_closes_the_lessons() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.lesson("halve-the-step", 1).wait(6.0);
    // First, Esc stops the actions of the page and clears messages.
    for _ in 0..3 {
        stage.press("\u{1b}");
    }
    stage.shows("L lists the lessons, q quits");
    stage.press("L").press("\u{1b}").press("\u{1b}");
    assert!(stage.lab.view().sheet.is_none());
}

#[test]
fn the_list_of_files_shows_only_files_with_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let preset = gyrolab::engine::scenario::presets::find("cusps")
        .unwrap()
        .text;
    write("mine.toml", preset);
    write("broken.toml", "[motion]\ntime_step_s = -1\n");
    write("dotted.toml", "title = 'x'\nmotion.time_step_s = 1\n");
    write("other.toml", "[package]\nname = 'motion'\n");
    let header: String = preset.lines().map(|line| format!("# {line}\n")).collect();
    write("run.csv", &format!("{header}step,t_s\n0,0\n"));
    write("table.csv", "a,b\n1,2\n");
    let mut browser = gyrolab::lab::browser::Browser::default();
    browser.begin(folder.path(), "method-2", |_| true);
    let files = browser.shown().into_iter().filter(|entry| entry.is_file);
    let names = files.map(|entry| entry.name.rsplit('/').next().unwrap());
    let all = ["broken.toml", "dotted.toml", "mine.toml", "run.csv"];
    assert!(names.eq(all));
    assert_eq!((browser.files(), browser.others), (4, 2));
}

#[test]
fn the_browser_enters_and_leaves_folders() {
    let root = tempfile::tempdir().unwrap();
    let inner = root.path().join("runs").join("june");
    std::fs::create_dir_all(&inner).unwrap();
    std::fs::create_dir(root.path().join(".hidden")).unwrap();
    let preset = gyrolab::engine::scenario::presets::find("cusps")
        .unwrap()
        .text;
    std::fs::write(inner.join("mine.toml"), preset).unwrap();
    std::fs::write(root.path().join("first.toml"), preset).unwrap();
    // Like a lab confined to its folder.
    let may_be_read = |path: &Path| path.starts_with(root.path());
    let mut browser = Browser::default();
    browser.begin(root.path(), "", may_be_read);
    let shown = |list: &Browser| -> Vec<String> {
        let all = list.shown().into_iter();
        let listed = all.filter(|entry| entry.is_file || entry.is_folder);
        listed
            .map(|entry| entry.name.replace(root.path().to_str().unwrap(), ""))
            .collect()
    };
    // There is no entry that leads out of the folder.
    assert_eq!(shown(&browser), ["/runs/", "/first.toml"]);
    assert!(!browser.enter(may_be_read), "a preset is not a folder");
    let enter = |list: &mut gyrolab::lab::browser::Browser, name: &str| {
        list.filter_by(|line| line.push_str(name));
        list.enter(may_be_read)
    };
    assert!(enter(&mut browser, "runs/"));
    assert_eq!(shown(&browser), ["../", "/runs/june/"]);
    // The first entry of the folder is selected.
    assert!(browser.enter(may_be_read));
    assert_eq!(shown(&browser), ["../", "/runs/june/mine.toml"]);
    assert!(browser.choice().unwrap().is_file);
    for above in ["/runs", ""] {
        assert!(enter(&mut browser, "../"));
        let folder = browser.folder().map(Path::to_path_buf);
        let wanted = (!above.is_empty()).then(|| root.path().join("runs"));
        assert_eq!(folder, wanted);
        assert!(
            browser.choice().unwrap().is_folder,
            "the folder that was left"
        );
    }
    assert_eq!(shown(&browser), ["/runs/", "/first.toml"]);
    // An unconfined lab can also go up from the first folder.
    let runs = root.path().join("runs");
    browser.begin(&runs, "", |_| true);
    assert_eq!(shown(&browser)[0], "../");
    browser.filter_by(|line| line.push_str("../"));
    assert!(browser.enter(|_| true));
    let wanted = std::fs::canonicalize(&runs).unwrap();
    assert_eq!(browser.folder(), wanted.parent());
    let back = browser.choice().unwrap().name.clone();
    assert_eq!(Path::new(&back), wanted, "the folder that was left");
}

#[test]
fn a_file_in_a_folder_is_opened_with_enter() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("runs")).unwrap();
    let preset = gyrolab::engine::scenario::presets::find("cusps")
        .unwrap()
        .text;
    let title = preset.replace("title = \"Cusps\"", "title = \"Cusps of June\"");
    std::fs::write(folder.path().join("runs/mine.toml"), title).unwrap();
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.lab.files_mut().work_in(folder.path());
    stage.press("oruns").shows("press Enter to list its files");
    stage.press("\n");
    stage.shows("file in").shows("mine.toml").shows("../");
    for _ in 0..200 {
        std::thread::sleep(std::time::Duration::from_millis(5));
        stage.wait(0.1);
    }
    stage.press("\n").wait(0.2);
    for _ in 0..200 {
        std::thread::sleep(std::time::Duration::from_millis(5));
        stage.wait(0.0);
    }
    stage.shows("Cusps of June");
}

#[test]
fn keys_that_play_are_not_offered_after_a_breakdown() {
    let mut stage = Stage::open("method-2", &["motion.scheme='rk4'"], LARGE);
    stage.commands("pause = true");
    stage.shows("space run").shows(", step");
    stage.commands("go_to = 2000");
    assert!(stage.lab.player().run().simulation().has_ended());
    stage.shows_no("space run").shows_no(", step");
    stage.press(",").shows("space run").shows(", step");
}

#[test]
fn the_next_page_is_offered_only_with_an_open_lesson() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.lesson("halve-the-step", 1).wait(6.0);
    stage.shows("n next").press("L");
    stage.shows_no("n next");
}
