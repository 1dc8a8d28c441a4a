//! The lab without a terminal, from keys to pictures: snapshots of every mode, complete sessions, and properties at random
//! sizes and states.

use crate::support::stage::{LARGE, SMALL, Stage, picture};
use crate::support::words::has_all;
use gyrolab::engine::recording::RecordedCurve;
use gyrolab::engine::scenario::presets::PRESETS;
use gyrolab::lab::LabRequest;
use gyrolab::tui::keymap::{BINDINGS, Key, Mode};
use gyrolab::tui::screen;
use proptest::prelude::*;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::time::Duration;

#[test]
fn the_lab_matches_its_snapshots() {
    for (name, size) in [("small", SMALL), ("large", LARGE)] {
        let shown = picture("wobble-push", size, 5.0, "t");
        insta::assert_snapshot!(format!("wobble_push_exact_{name}"), shown);
    }
}

/// Presets with special features: the report's method, a push, no weight, friction, a body of parts, a flat block.
const FIRST_SIGHTS: [&str; 6] = [
    "method-2",
    "wobble-push",
    "torque-free",
    "life-of-a-top",
    "wing-nut",
    "phone",
];

#[test]
fn opened_presets_match_their_snapshots() {
    for preset in FIRST_SIGHTS {
        let sizes = [SMALL, LARGE].map(|size| picture(preset, size, 6.0, ""));
        insta::assert_snapshot!(format!("first_sight_{preset}"), sizes.join("\n"));
    }
}

#[test]
fn a_strip_updated_once_per_second_says_so() {
    for size in [SMALL, Rect::new(0, 0, 120, 40), LARGE] {
        let mut stage = Stage::open("wobble-push", &["view.speed=1"], size);
        stage.wait(4.0).shows_no("every 1 s");
        let fast = ["view.speed=1000", "motion.steps=1000000"];
        let mut quick = Stage::open("wobble-push", &fast, size);
        quick.wait(4.0).shows("every 1 s");
        quick.commands("pause = true").shows_no("every 1 s");
    }
}

#[test]
fn windows_match_their_snapshots() {
    insta::assert_snapshot!("help_small", picture("method-2", SMALL, 1.0, "?"));
    insta::assert_snapshot!("help_large", picture("method-2", LARGE, 1.0, "?"));
    // The list of files is excluded because it depends on the folder.
    insta::assert_snapshot!("filter_small", picture("method-2", SMALL, 1.0, "ocus"));
    insta::assert_snapshot!("filter_large", picture("method-2", LARGE, 1.0, "ocus"));
}

#[test]
fn full_screen_panes_match_their_snapshots() {
    insta::assert_snapshot!("traces_fill", picture("loops", SMALL, 4.0, "f"));
    insta::assert_snapshot!("from_above_fill", picture("loops", SMALL, 4.0, "\tf"));
    insta::assert_snapshot!("three_d_fill", picture("loops", SMALL, 4.0, "d"));
    insta::assert_snapshot!("three_d_turned", picture("loops", SMALL, 4.0, "d9↑"));
}

/// Returns the keys that change the marker setting `times` times.
fn dots(times: usize) -> String {
    format!("c↓↓↓{}\u{1b}", "→".repeat(times))
}

#[test]
fn markers_and_small_screens_match_their_snapshots() {
    insta::assert_snapshot!("octants", picture("cusps", SMALL, 3.0, &dots(1)));
    insta::assert_snapshot!("half_blocks", picture("cusps", SMALL, 3.0, &dots(2)));
    insta::assert_snapshot!("points", picture("cusps", SMALL, 3.0, &dots(3)));
    insta::assert_snapshot!("ascii", picture("cusps", SMALL, 3.0, &dots(4)));
    for (name, width, height) in [("two_panes", 60, 16), ("one_pane", 30, 10)] {
        let size = Rect::new(0, 0, width, height);
        insta::assert_snapshot!(name, picture("cusps", size, 3.0, ""));
    }
}

#[test]
fn the_run_can_be_paused_stepped_and_resumed() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.wait(1.0);
    assert_eq!(stage.step(), 200);
    stage.press(" ").wait(1.0).shows("paused");
    stage.shows("space run");
    assert_eq!(stage.step(), 200);
    stage.press(".").wait(0.1);
    assert_eq!(stage.step(), 201);
    stage.press("10").shows("10: press a key").press(".");
    stage.wait(0.1);
    assert_eq!(stage.step(), 211);
    stage.press(" ").wait(1.0).shows("► ×20");
    stage.shows("space pause");
    assert_eq!(stage.step(), 411);
    stage.press("r").wait(0.0);
    assert!(stage.step() < 30);
}

#[test]
fn the_view_in_focus_is_zoomed() {
    let mut stage = Stage::open("cusps", &[], SMALL);
    stage.press("\tz").shows("from above (m) ×2").press("2z");
    stage.shows("from above (m) ×10");
    stage.press("Z").shows("from above (m) ×5").shows("z zoom");
    stage.press("9Z9Z").shows("from above (m) ×0.5");
    stage.shows("this is the smallest");
    stage.press("9z9z").shows("from above (m) ×100");
    stage.shows("this is the largest");
    stage.key(Key::Home);
    stage.wait(0.0).shows_no("(m) ×");
    stage.press("dz").shows("3-D ×2");
}

#[test]
fn a_note_is_hidden_when_it_may_no_longer_apply() {
    let set = ["motion.time_step_s=0.01", "start.tilt_deg=30"];
    let mut stage = Stage::open("method-2", &set, SMALL);
    stage.shows("differs from the preset method-2: dt 0.01 s, not 0.1, start.tilt_deg 30, not");
    stage.shows_no("lmost a circle");
    stage.commands("open = 'method-2'").shows("lmost a circle");
    Stage::open("method-2", &["motion.steps=50", "view.speed=2"], SMALL).shows("lmost a circle");
    let own_note = ["motion.time_step_s=0.01", "view.look_at=\"mine\""];
    Stage::open("method-2", &own_note, SMALL).shows("mine");
}

#[test]
fn playback_speed_does_not_depend_on_the_time_step() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.press("+").shows("×50").wait(1.0);
    assert_eq!(stage.step(), 500);
    stage.press("r---").shows("×5").wait(1.0);
    assert_eq!(stage.lab.player().motion().time_step_s, 0.1);
    assert!((49..=51).contains(&stage.step()), "{}", stage.step());
    stage.press("99-").shows("×1e-4").press("99+").shows("top");
}

#[test]
fn the_run_pauses_once_at_its_end() {
    let mut stage = Stage::open("method-2", &["motion.steps=50"], SMALL);
    stage.wait(3.0);
    stage.shows("end of the run: space continues, r restarts");
    stage.shows("Next: t draws the exact motion");
    stage.shows("paused");
    assert_eq!(stage.step(), 50);
    stage.press(" ").wait(1.0).shows_no("end of the run");
    assert!(stage.step() > 200);
}

#[test]
fn top_speed_uses_all_available_time() {
    let mut stage = Stage::open("method-2", &["motion.steps=100000000"], SMALL);
    stage.commands("speed = 'top'").wait(0.5).shows("top ×");
    // A time slice lasts 25 ms and each reading of the clock 50 µs: 500 readings, with some hundred steps between them.
    assert!(stage.step() > 100_000, "{}", stage.step());
}

#[test]
fn millions_of_requested_steps_do_not_block_keys() {
    let mut stage = Stage::open("method-2", &["motion.steps=1000"], SMALL);
    for stop in ["\u{1b}", " "] {
        stage.press("r9000000.").wait(0.1).shows("stepping: 8,");
        stage.shows("to go, Esc stops");
        let underway = stage.step();
        assert!((1000..9_000_000).contains(&underway), "{underway}");
        stage.press(stop).shows("paused").shows("stopped with 8,");
        let stopped = stage.step();
        stage.wait(1.0).shows("paused");
        assert_eq!(stage.step(), stopped);
    }
}

#[test]
fn the_exact_command_toggles_the_exact_motion() {
    let names_exact = |stage: &Stage| {
        let traces = |line: &str| line.chars().take(28).collect::<String>();
        let picture = stage.picture();
        picture
            .lines()
            .take(18)
            .any(|line| traces(line).contains("exact"))
    };
    let mut stage = Stage::open("method-2", &["motion.time_step_s=0.05"], SMALL);
    stage.wait(0.2).commands("pause = true");
    assert!(!names_exact(&stage));
    stage.commands("exact = true").wait(6.0);
    assert!(names_exact(&stage), "{}", stage.picture());
    let health = &stage.lab.player().reading.readouts.health;
    let distance = health.deviation.unwrap().distance_m;
    assert!(distance > 0.0 && distance < 0.05, "{distance}");
    stage.commands("exact = false").wait(6.0);
    assert!(!names_exact(&stage), "{}", stage.picture());
}

#[test]
fn the_range_of_a_strip_includes_the_exact_motion() {
    // The scheme damps the nutation, so the run does not reach the lowest position of the exact motion at 36.69 degrees.
    let set = ["motion.scheme=\"report\"", "motion.time_step_s=0.02"];
    let mut stage = Stage::open("cusps", &set, SMALL);
    stage.wait(3.0).commands("pause = true");
    let highest = |screen: &Stage| {
        let window = &screen.lab.view().window;
        window.range(RecordedCurve::Tilt).max
    };
    assert!(highest(&stage) < 36.68);
    stage.commands("exact = true").wait(1.0);
    assert!(highest(&stage) > 36.68);
}

#[test]
fn the_browser_opens_the_filtered_entry() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.press("o").shows("> method-2").press("↓");
    stage.shows("> wobble-push").shows("The wobble push");
    stage.press("z z").shows("no matching preset or file");
    stage.press("\n").shows("nothing is selected");
    stage.press("\u{1b}").shows("> method-2").press("loo");
    stage.shows("> loops").press("\n");
    stage.shows("Loops").shows_no("type to filter").wait(1.0);
    assert_eq!(stage.lab.player().run().scenario().file.title, "Loops");
    assert!(stage.step() > 500);
}

#[test]
fn esc_closes_one_window_at_a_time_and_never_quits() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.press("ocus?").shows("cus?_");
    for _ in 0..5 {
        assert_eq!(stage.key(Key::Esc), None);
    }
    assert_eq!(stage.lab.popups().mode, Mode::Lab);
    stage.shows("q quits");
    assert_eq!(stage.key(Key::Char('q')), Some(LabRequest::Quit));
}

#[test]
fn every_pane_can_fill_the_screen() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    for pane in ["z (m)", "from above", "3-D", "values"] {
        let panes = |shown: &Stage| screen::layout(&shown.lab, true, SMALL).panes.len();
        stage.press("f").shows(pane);
        assert_eq!(panes(&stage), 1);
        stage.press("f");
        assert_eq!(panes(&stage), 3);
        stage.press("\t");
    }
    stage.press("d").shows(" 3-D ").press("d");
    stage.shows("values");
}

#[test]
fn resizing_shows_the_panes_that_fit() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.wait(1.0).shows(" 3-D ").shows("values");
    for (width, height, shown, hidden) in
        [(100, 30, "values", "3-D"), (60, 20, "from above", "values")]
    {
        stage.size = Rect::new(0, 0, width, height);
        screen::fit(&mut stage.lab, stage.size);
        stage.shows(shown).shows_no(hidden);
    }
    stage.shows("lmost a circle").shows("z swing by");
    stage.size = Rect::new(0, 0, 75, 23);
    screen::fit(&mut stage.lab, stage.size);
    stage.shows("lmost a circle").shows("80x24 shows more");
}

#[test]
fn a_paused_lab_does_not_change() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.wait(1.0).commands("pause = true").wait(6.0);
    stage.lab.take_changed();
    stage.wait(10.0);
    assert!(!stage.lab.take_changed());
}

#[test]
fn a_notice_disappears_after_a_time_or_at_the_next_key() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.press(" w").shows("the traces show").wait(5.2);
    stage.shows_no("the traces show").shows("lmost a circle");
    stage.press("ww").shows("the traces show").press("f");
    stage.shows_no("the traces show").press("fo");
    stage.press("/zzz\n");
    stage.shows("nothing is selected").press("\u{1b}");
    stage.shows_no("nothing is selected");
}

#[test]
fn keys_without_effect_say_why() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage
        .press("!")
        .shows("! does nothing here; ? lists the keys");
    stage.press("\n").shows("Enter types it");
    stage
        .press("/")
        .shows("/_ ")
        .shows(" 1 of ")
        .press("\u{1b}");
    stage.press("99+").shows_no("this is").press("+");
    stage.shows("this is the top speed");
    stage.press("99-").shows("a step takes 1000 s").press("-");
    stage.shows("this is the lowest speed");
}

#[test]
fn at_high_speed_numbers_and_pictures_belong_to_one_step() {
    // At a constant speed, numbers are read four times per second: every 2500 steps of 0.1 s, and up to a frame later.
    for (command, most_late) in [
        ("speed = 1000", 3_500),
        ("speed = 'top'", 0),
        ("step = 9000000", 0),
    ] {
        let mut stage = Stage::open("method-2", &["motion.steps=100000000"], SMALL);
        stage.commands(command);
        for _ in 0..7 {
            stage.wait(0.1);
            let read = stage.lab.player().reading.readouts.sample.step;
            let late = stage.step() - read;
            assert!(late <= most_late, "{command}: {late}");
            stage.shows(&format!(" {read} "));
        }
        // A paused lab shows the numbers of its own step.
        stage.commands("pause = true").press("\u{1b}");
        let read = stage.lab.player().reading.readouts.sample.step;
        assert_eq!(read, stage.step(), "{command}");
    }
}

#[test]
fn advice_is_found_in_the_background() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.shows("checking ...");
    stage.lab.take_advice();
    stage.wait(5.0).commands("pause = true");
    for _ in 0..600 {
        std::thread::sleep(Duration::from_millis(100));
        if stage.wait(0.0).lab.adviser().advice().is_some() {
            break;
        }
    }
    stage.shows(" m off").shows("a: dt 0.002 s");
    stage.commands("open = 'wobble-push'").shows_no("a: dt ");
}

#[test]
fn non_finite_numbers_stop_the_run_with_a_message() {
    let set = [
        "motion.time_step_s=1e300",
        "motion.gravity_m_per_s2=1e10",
        "start.momentum_Js=[1e5, 1e5, 1e5]",
    ];
    let mut stage = Stage::open("method-2", &set, SMALL);
    stage.commands("speed = 'top'").wait(1.0);
    stage.shows("no longer finite at step").shows("paused");
}

#[test]
fn ascii_markers_give_a_pure_ascii_screen() {
    let mut stage = Stage::open("method-2", &["title=\"Kreisel über ∂\""], LARGE);
    stage.wait(2.0).press("tc↓↓↓←\u{1b}").wait(0.5);
    assert!(stage.picture().is_ascii(), "{}", stage.picture());
    stage.press("?");
    assert!(stage.picture().is_ascii());
}

#[test]
fn the_header_keeps_the_clock_before_the_title() {
    for (width, height) in [(80, 24), (79, 23), (60, 18), (50, 14), (40, 10), (30, 8)] {
        let mut stage = Stage::open("wobble-push", &[], Rect::new(0, 0, width, height));
        stage.wait(1.0).commands("pause = true");
        let header = stage.picture().lines().next().unwrap().to_owned();
        has_all(&header, ["20.0 s", "200", "paused"]);
        let has_room = header.contains("report   dt 0.1 s");
        assert!(width < 79 || has_room, "{header}");
    }
}

#[test]
fn the_help_is_complete_at_every_size() {
    for (width, height) in [(200, 50), (80, 24), (60, 18), (40, 10), (24, 60)] {
        let mut stage = Stage::open("method-2", &[], Rect::new(0, 0, width, height));
        stage.press("?");
        let mut seen = String::new();
        for _ in 0..250 {
            let layout = screen::layout(&stage.lab, true, stage.size);
            let rows = usize::from(layout.header.bottom()) + 1..layout.verdict.y.into();
            let picture = stage.picture();
            let lines = picture.lines().skip(rows.start).take(rows.len());
            seen.extend(lines.map(|line| line.trim().to_owned() + " "));
            stage.press("↓");
        }
        let seen = seen.split_whitespace().collect::<Vec<_>>().join(" ");
        has_all(&seen, ["Backspace Ctrl-H", "Shift-Tab"]);
        for word in BINDINGS.iter().flat_map(|row| row.help.split(' ')) {
            assert!(seen.contains(word), "{word} at {width}x{height}");
        }
        assert!(!seen.contains(".."), "cut at {width}x{height}");
    }
}

/// The fonts of the Linux console have the 256 characters of code page 437, and some of Latin-1.
#[test]
fn half_blocks_need_no_rare_glyphs() {
    for keys in ["t", "d", "?", "oloops"] {
        let mut stage = Stage::open("method-2", &[], LARGE);
        stage.wait(2.0).press(&dots(2)).press(keys);
        let picture = stage.picture();
        assert_eq!(
            picture
                .chars()
                .find(|c| !c.is_ascii() && !"─│├┤═▀▄█■·°×►◄▲▼♦Ωτ²".contains(*c)),
            None,
            "{picture}"
        );
    }
}

fn any_key() -> impl Strategy<Value = Key> {
    let bound: Vec<Key> = BINDINGS
        .iter()
        .flat_map(|row| row.keys.iter().copied())
        .collect();
    prop_oneof![8 => prop::sample::select(bound), 1 => prop::char::range('0', 'z').prop_map(Key::Char)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn random_keys_and_sizes_never_break_the_lab(
        keys in prop::collection::vec(any_key(), 0..40),
        sizes in prop::collection::vec((1u16..230, 1u16..70), 1..6),
        preset in 0..PRESETS.len(),
    ) {
        let mut stage = Stage::open(PRESETS[preset].name, &[], SMALL);
        for (index, key) in keys.into_iter().enumerate() {
            let (width, height) = sizes[index % sizes.len()];
            stage.size = Rect::new(0, 0, width, height);
            screen::fit(&mut stage.lab, stage.size);
            stage.key(key);
            stage.wait(0.1);
            prop_assert_eq!(stage.picture().lines().count(), height as usize);
        }
    }

    #[test]
    fn nothing_is_drawn_outside_the_screen_area(width in 0u16..100, height in 0u16..40, keys in "[fdtm?o]{0,4}") {
        let mut stage = Stage::open("cusps", &[], Rect::new(0, 0, width, height));
        stage.wait(0.5).press(&keys);
        let around = Rect::new(0, 0, width + 6, height + 6);
        let mut buffer = Buffer::filled(around, ratatui::buffer::Cell::new("#"));
        let inside = Rect::new(3, 3, width, height);
        screen::draw(&stage.lab, true, inside, &mut buffer);
        for position in around.positions().filter(|position| !inside.contains(*position)) {
            prop_assert_eq!(buffer[position].symbol(), "#", "{:?}", position);
        }
    }


    #[test]
    fn no_pane_draws_outside_its_area(
        width in 0u16..90, height in 0u16..40, seconds in 0.0..3.0f64, keys in "[tm]{0,4}", preset in 0..PRESETS.len()
    ) {
        let mut stage = Stage::open(PRESETS[preset].name, &[], SMALL);
        stage.wait(seconds).press(&keys);
        let around = Rect::new(0, 0, width + 6, height + 6);
        let inside = Rect::new(3, 3, width, height);
        for pane in gyrolab::lab::view::Pane::ALL {
            let mut buffer = Buffer::filled(around, ratatui::buffer::Cell::new("#"));
            screen::draw_pane(&stage.lab, pane, inside, &mut buffer);
            for position in around.positions().filter(|position| !inside.contains(*position)) {
                prop_assert_eq!(buffer[position].symbol(), "#", "{:?} at {:?}", pane, position);
            }
        }
    }
}
