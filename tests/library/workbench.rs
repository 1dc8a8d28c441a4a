//! The lab without a terminal, from keys to pictures: pictures of every mode, journeys, and properties at random sizes
//! and states.

use crate::support::stage::{LARGE, SMALL, Stage, picture};
use crate::support::words::has_all;
use gyrolab::engine::scenario::presets::PRESETS;
use gyrolab::lab::LabRequest;
use gyrolab::tui::keymap::{BINDINGS, Key, Mode};
use gyrolab::tui::screen;
use proptest::prelude::*;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::collections::BTreeSet;
use std::time::Duration;

#[test]
fn pictures_of_the_lab() {
    for (name, size) in [("small", SMALL), ("large", LARGE)] {
        let shown = picture("wobble-push", size, 5.0, "t");
        insta::assert_snapshot!(format!("wobble_push_exact_{name}"), shown);
    }
}

/// Presets that show something which the others do not: the report's method, a push, no weight, friction, a body of parts,
/// a flat block.
const FIRST_SIGHTS: [&str; 6] = [
    "method-2",
    "wobble-push",
    "torque-free",
    "life-of-a-top",
    "wing-nut",
    "phone",
];

#[test]
fn presets_at_first_sight() {
    for preset in FIRST_SIGHTS {
        let sizes = [SMALL, LARGE].map(|size| picture(preset, size, 6.0, ""));
        insta::assert_snapshot!(format!("first_sight_{preset}"), sizes.join("\n"));
    }
}

#[test]
fn a_strip_that_stands_still_at_high_speed_says_so() {
    for size in [SMALL, Rect::new(0, 0, 120, 40), LARGE] {
        let mut stage = Stage::open("wobble-push", &["view.speed=1"], size);
        stage.wait(4.0).shows_no("held");
        let fast = ["view.speed=1000", "motion.steps=1000000"];
        let mut quick = Stage::open("wobble-push", &fast, size);
        quick.wait(4.0).shows("held");
        quick.commands("pause = true").shows_no("held");
    }
}

#[test]
fn pictures_of_what_lies_on_top() {
    insta::assert_snapshot!("help_small", picture("method-2", SMALL, 1.0, "?"));
    insta::assert_snapshot!("help_large", picture("method-2", LARGE, 1.0, "?"));
    // The list of files is left out, because it depends on the folder.
    insta::assert_snapshot!("filter_small", picture("method-2", SMALL, 1.0, "ocus"));
    insta::assert_snapshot!("filter_large", picture("method-2", LARGE, 1.0, "ocus"));
}

#[test]
fn a_strip_with_a_cursor_still_says_its_range() {
    let mut stage = Stage::open("wobble-push", &[], SMALL);
    stage.wait(2.0);
    stage.key(Key::Left);
    stage.wait(1.0);
    let picture = stage.picture();
    let mut heads = picture.lines().filter_map(|line| line.split('│').nth(1));
    let head = heads.find(|head| head.starts_with("x ")).unwrap();
    assert!(head.contains(" m (-1.0..1.0)"), "{head}");
}

#[test]
fn a_legend_names_every_mark_of_the_exact_motion() {
    for size in [SMALL, Rect::new(0, 0, 120, 40), LARGE] {
        for preset in ["method-2", "wobble-push"] {
            let mut stage = Stage::open(preset, &[], size);
            stage.press("t").wait(1.0);
            stage.shows("o now").shows("e exact").shows("* both");
            stage.press("i").commands("set = { 'start.tilt_deg' = 40 }");
            stage.wait(6.0).shows("o now").shows("pinned");
            stage.shows("* both");
        }
    }
    let mut stage = Stage::open("wobble-push", &[], SMALL);
    stage.commands("pause = true\ngo_to = '10 s'");
    stage.press("t").wait(1.0).press("d").wait(0.3);
    stage.shows("L angular momentum").shows("dL = τ dt");
    stage.shows("F push").shows("+ pivot").shows("* axle top");
    stage.shows("dots: exact");
    let mut large = Stage::open("wobble-push", &[], LARGE);
    large.commands("pause = true\ngo_to = '10 s'");
    large.wait(0.3);
    large.shows("L angular momentum").shows("dL = τ dt");
    large.shows("Ω angular velocity").shows("g weight");
    large.shows("τ torque").shows("F push");
}

#[test]
fn pictures_of_one_pane() {
    insta::assert_snapshot!("traces_fill", picture("loops", SMALL, 4.0, "f"));
    insta::assert_snapshot!("from_above_fill", picture("loops", SMALL, 4.0, "\tf"));
    insta::assert_snapshot!("three_d_fill", picture("loops", SMALL, 4.0, "d"));
    insta::assert_snapshot!("three_d_turned", picture("loops", SMALL, 4.0, "d9↑"));
}

/// The keys that choose other dots: the setting is changed so many times.
fn dots(times: usize) -> String {
    format!("c↓↓↓{}\u{1b}", "→".repeat(times))
}

#[test]
fn pictures_of_markers_and_small_screens() {
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
fn a_teacher_stops_steps_and_goes_on() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.wait(1.0);
    assert_eq!(stage.step(), 200);
    stage.press(" ").wait(1.0).shows("paused");
    stage.shows("space run");
    assert_eq!(stage.step(), 200);
    stage.press(".").wait(0.1);
    assert_eq!(stage.step(), 201);
    stage.press("10").shows("10: now the key").press(".");
    stage.wait(0.1);
    assert_eq!(stage.step(), 211);
    stage.press(" ").wait(1.0).shows("► ×20");
    stage.shows("space pause");
    assert_eq!(stage.step(), 411);
    stage.press("r").wait(0.0);
    assert!(stage.step() < 30);
}

#[test]
fn the_path_before_is_named_beside_the_exact_motion_where_there_is_room() {
    let mut stage = Stage::open("cusps", &[], LARGE);
    stage.wait(1.0).press("t").shows("e exact");
    stage.shows("dotted: before");
}

#[test]
fn round_pictures_are_zoomed_where_they_have_the_focus() {
    let mut stage = Stage::open("cusps", &[], SMALL);
    stage.press("\tz").shows("from above ×2").press("2z");
    stage.shows("from above ×10");
    stage.press("Z").shows("from above ×5").shows("z zoom");
    stage.press("9Z9Z").shows("from above ×0.5");
    stage.shows("this is the smallest");
    stage.press("9z9z").shows("from above ×100");
    stage.shows("this is the largest");
    stage.key(Key::Home);
    stage.wait(0.0).shows("┌ from above ─");
    stage.press("dz").shows("┌ 3-D ×2 ─");
}

#[test]
fn a_note_that_may_not_hold_any_more_is_not_shown() {
    let set = ["motion.time_step_s=0.01", "start.tilt_deg=30"];
    let mut stage = Stage::open("method-2", &set, SMALL);
    stage.shows("differs from the preset method-2: dt 0.01 s, not 0.1, start.tilt_deg 30, not");
    stage.shows_no("lmost a circle");
    stage.commands("open = 'method-2'").shows("lmost a circle");
    Stage::open("method-2", &["motion.steps=50", "view.speed=2"], SMALL).shows("lmost a circle");
    let set = ["motion.time_step_s=0.01", "view.look_at=\"mine\""];
    Stage::open("method-2", &set, SMALL).shows("mine");
}

#[test]
fn speed_is_apart_from_the_time_step() {
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
    stage.shows("end of the run: space goes on, r begins again");
    stage.shows("Next: t draws the exact motion");
    stage.shows("paused");
    assert_eq!(stage.step(), 50);
    stage.press(" ").wait(1.0).shows_no("end of the run");
    assert!(stage.step() > 200);
}

#[test]
fn top_speed_is_as_fast_as_there_is_time_for() {
    let mut stage = Stage::open("method-2", &["motion.steps=100000000"], SMALL);
    stage.commands("speed = 'top'").wait(0.5).shows("top ×");
    // A slice lasts 25 ms and each reading of the clock 50 µs: 500 readings, with some hundred steps between two.
    assert!(stage.step() > 100_000, "{}", stage.step());
}

#[test]
fn steps_asked_for_by_the_million_do_not_hold_up_the_keys() {
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
fn the_exact_motion_and_the_distance_from_it() {
    let mut stage = Stage::open("method-2", &["motion.time_step_s=0.05"], SMALL);
    stage.wait(0.2).commands("pause = true").shows_no("e exact");
    stage.commands("exact = true").wait(6.0).shows(" m off");
    stage.shows("e exact");
    let health = &stage.lab.player().reading.readouts.health;
    let distance = health.deviation.unwrap().distance_m;
    assert!(distance > 0.0 && distance < 0.05, "{distance}");
    stage.commands("exact = false").wait(6.0);
    stage.shows_no("e exact");
}

#[test]
fn the_strips_have_room_for_the_exact_motion_too() {
    // The scheme damps the nutation: the run stays above the exact motion's lowest, at 36.69 degrees.
    let set = ["motion.scheme=\"report\"", "motion.time_step_s=0.02"];
    let mut stage = Stage::open("cusps", &set, SMALL);
    stage.wait(3.0).commands("pause = true");
    let highest = |screen: &Stage| {
        let picture = screen.picture();
        let label = picture.lines().find(|line| line.contains("│tilt "));
        let words = label.unwrap().split(' ');
        let numbers: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
        numbers[1]
    };
    assert!(highest(&stage) < 36.68);
    stage.commands("exact = true").wait(1.0);
    assert!(highest(&stage) > 36.68);
}

#[test]
fn the_browser_opens_what_the_filter_finds() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.press("o").shows("> method-2").press("↓");
    stage.shows("> wobble-push").shows("The wobble push");
    stage.press("z z").shows("nothing has that in its name");
    stage.press("\n").shows("nothing is selected");
    stage.press("\u{1b}").shows("> method-2").press("loo");
    stage.shows("> loops").press("\n");
    stage.shows("Loops").shows_no("type to filter").wait(1.0);
    assert_eq!(stage.lab.player().run().scenario().file.title, "Loops");
    assert!(stage.step() > 500);
}

#[test]
fn esc_closes_one_thing_at_a_time_and_never_leaves() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.press("ocus?").shows("cus?_");
    for _ in 0..5 {
        assert_eq!(stage.key(Key::Esc), None);
    }
    assert_eq!(stage.lab.popups().mode, Mode::Lab);
    stage.shows("q leaves");
    assert_eq!(stage.key(Key::Char('q')), Some(LabRequest::Quit));
}

#[test]
fn any_pane_fills_the_screen_and_comes_back() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    for pane in ["z (m)", "from above", "values"] {
        let panes = |stage: &Stage| screen::layout(&stage.lab, true, SMALL).panes.len();
        stage.press("f").shows(pane);
        assert_eq!(panes(&stage), 1);
        stage.press("f");
        assert_eq!(panes(&stage), 3);
        stage.press("\t");
    }
    stage.press("d").shows(" 3-D ").press("\u{1b}");
    stage.shows("parameters");
}

#[test]
fn resizing_at_any_moment_shows_what_there_is_room_for() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.wait(1.0).shows(" 3-D ").shows("parameters");
    for (width, height, shown, hidden) in
        [(100, 30, "values", "3-D"), (60, 20, "from above", "values")]
    {
        stage.size = Rect::new(0, 0, width, height);
        screen::fit(&mut stage.lab, stage.size);
        stage.shows(shown).shows_no(hidden);
    }
    stage.shows("lmost a circle").shows("swing of z");
    stage.size = Rect::new(0, 0, 79, 23);
    screen::fit(&mut stage.lab, stage.size);
    stage.shows("lmost a circle").shows("80x24 shows more");
}

#[test]
fn nothing_changes_while_it_stands_still() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.wait(1.0).commands("pause = true").wait(6.0);
    stage.lab.take_changed();
    stage.wait(10.0);
    assert!(!stage.lab.take_changed());
}

#[test]
fn a_notice_goes_with_time_and_at_the_next_key() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.press(" w").shows("the traces show").wait(5.2);
    stage.shows_no("the traces show").shows("lmost a circle");
    stage.press("w").shows("the traces show").press("f");
    stage.shows_no("the traces show").press("f↑");
    stage.shows("the upper strip shows");
    stage.press("o").shows_no("move the cursor here");
    stage.press("/zzz\n");
    stage.shows("nothing is selected").press("\u{1b}");
    stage.shows_no("nothing is selected");
}

#[test]
fn what_does_nothing_says_why() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.press("!").shows("no key ! here; ? lists the keys");
    stage.press("\n").shows("Enter types it");
    stage.press("/").shows("/_ 1 of").press("\u{1b}");
    stage.press("99+").shows_no("this is").press("+");
    stage.shows("this is the top speed");
    stage.press("99-").shows("a step takes 1000 s").press("-");
    stage.shows("this is the lowest speed");
}

#[test]
fn at_speed_numbers_and_pictures_are_of_one_moment() {
    for command in ["speed = 1000", "speed = 'top'", "step = 9000000"] {
        let mut stage = Stage::open("method-2", &["motion.steps=100000000"], SMALL);
        stage.commands(command);
        for _ in 0..7 {
            stage.wait(0.1);
            let read = stage.lab.player().reading.readouts.sample.step;
            assert_eq!(read, stage.step(), "{command}");
        }
    }
}

#[test]
fn what_would_mend_a_run_is_found_on_the_side() {
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
    stage.shows(" m off").shows("a dt 0.002 s");
    stage.commands("open = 'wobble-push'").shows_no("a dt ");
}

#[test]
fn numbers_that_are_not_finite_stop_the_run_and_are_named() {
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
fn ascii_is_ascii_to_the_last_cell() {
    let mut stage = Stage::open("method-2", &["title=\"Kreisel über ∂\""], LARGE);
    stage.wait(2.0).press("tc↓↓↓←\u{1b}").wait(0.5);
    assert!(stage.picture().is_ascii(), "{}", stage.picture());
    stage.press("?");
    assert!(stage.picture().is_ascii());
}

#[test]
fn every_number_is_on_the_screen_once_the_parameters_fill_it() {
    let mut stage = Stage::open("wobble-push", &[], SMALL);
    stage.wait(5.0).commands("pause = true");
    stage.shows("all values: e");
    let unfilled = stage.picture();
    assert_eq!(unfilled.matches("predicted").count(), 2, "{unfilled}");
    stage.commands("fill = 'parameters'");
    stage.shows_no("all of them");
    for label in "rim radius,gravity,nutation,|L|,Lz,energy,push,first step,E drift".split(',') {
        stage.shows(label);
    }
}

#[test]
fn the_header_keeps_the_clock_before_the_title() {
    for (width, height) in [(80, 24), (79, 23), (60, 18), (50, 14), (40, 10), (30, 8)] {
        let mut stage = Stage::open("wobble-push", &[], Rect::new(0, 0, width, height));
        stage.wait(1.0).commands("pause = true");
        let header = stage.picture().lines().next().unwrap().to_owned();
        has_all(&header, ["20.0 s", "step 200", "paused"]);
        let has_room = header.contains("report   dt 0.1 s");
        assert!(width < 79 || has_room, "{header}");
    }
}

#[test]
fn the_help_says_everything_at_every_size() {
    for (width, height) in [(200, 50), (80, 24), (60, 18), (40, 10), (24, 60)] {
        let mut stage = Stage::open("method-2", &[], Rect::new(0, 0, width, height));
        stage.press("?");
        let mut seen = String::new();
        for _ in 0..250 {
            let picture = stage.picture();
            seen.extend(picture.lines().map(|line| line.trim().to_owned() + " "));
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

#[test]
fn a_sign_on_the_path_in_space_shows_which_way_the_top_goes() {
    // From above, the top goes round against the clock once in 7.04 s, from where y is least.
    let mut stage = Stage::open("steady-slow", &[], SMALL);
    stage.commands("pause = true\nfill = '3d'\ncamera = { yaw_deg = 0, pitch_deg = 90 }");
    for (time_s, sign) in [(2.35, '▲'), (4.11, '◄'), (5.87, '▼'), (7.63, '►')] {
        stage.commands(&format!("go_to = '{time_s} s'")).wait(6.0);
        let picture = stage.picture();
        let (scene, _) = picture.split_once("L angular momentum").unwrap();
        let signs: String = scene.chars().filter(|c| "►◄▲▼".contains(*c)).collect();
        assert_eq!(signs, sign.to_string(), "{time_s} s\n{picture}");
        assert_eq!(scene.matches('■').count(), 1, "the hub\n{picture}");
    }
}

/// The Linux console's fonts have the 256 characters of the old PC, and some of Latin 1.
#[test]
fn half_blocks_need_no_rare_glyphs() {
    for keys in ["t", "d", "?", "oloops"] {
        let mut stage = Stage::open("method-2", &[], LARGE);
        stage.wait(2.0).press(&dots(2)).press(keys);
        let picture = stage.picture();
        assert_eq!(
            picture
                .chars()
                .find(|c| !c.is_ascii() && !"─│┌┐└┘├┤═▀▄█■·°×►◄▲▼Ωτ".contains(*c)),
            None,
            "{picture}"
        );
    }
}

#[test]
fn a_circle_is_round() {
    for marker in 0..3 {
        for (width, height) in [(80, 24), (100, 60), (131, 37), (200, 50), (90, 80)] {
            let mut stage = Stage::open("steady-slow", &[], Rect::new(0, 0, width, height));
            stage.wait(8.0).commands("fill = 'above'");
            stage.press(&dots(marker)).wait(6.0);
            let (across, down) = extent_of_the_path(&stage.picture());
            // A cell is twice as high as wide. At both ends the edge of the path may lie anywhere in a cell.
            let picture = stage.picture();
            let off = (across - 2.0 * down).abs();
            assert!(off <= 4.0, "{across} x {down}:\n{picture}");
        }
    }
}

/// Width and height of the path, cells.
fn extent_of_the_path(picture: &str) -> (f64, f64) {
    let (mut columns, mut rows) = (BTreeSet::new(), BTreeSet::new());
    for (y, line) in picture.lines().enumerate() {
        let dots = line
            .chars()
            .enumerate()
            .filter(|(_, c)| ('\u{2800}'..='\u{28ff}').contains(c) || "▀▄█•".contains(*c));
        // Not the timeline.
        for (x, _) in dots.filter(|_| line.starts_with('│')) {
            columns.insert(x);
            rows.insert(y);
        }
    }
    let span =
        |places: BTreeSet<usize>| (places.last().unwrap() - places.first().unwrap() + 1) as f64;
    (span(columns), span(rows))
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
    fn no_keys_at_no_size_break_anything(
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
    fn nothing_is_drawn_outside(width in 0u16..100, height in 0u16..40, keys in "[fdtm?o]{0,4}") {
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
    fn no_pane_draws_outside_itself(
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
