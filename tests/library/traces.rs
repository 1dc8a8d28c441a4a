//! The strips of the traces and the overview.

use crate::support::stage::{LARGE, SMALL, Stage};
use gyrolab::engine::data::QUANTITIES;
use gyrolab::engine::recording::RecordedCurve;
use gyrolab::engine::scenario::screen::DETAILS;
use gyrolab::lab::playback::strip::Strip;
use gyrolab::lab::view::Pane;
use gyrolab::lab::view::theme::{Background, Marker, Palette, Theme};
use gyrolab::tui::keymap::Key;
use gyrolab::tui::mouse::{Did, Mouse, Pointer};
use gyrolab::tui::screen;
use gyrolab::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

const MEDIUM: Rect = Rect {
    x: 0,
    y: 0,
    width: 120,
    height: 40,
};
const COLORS: Theme = Theme {
    palette: Palette::TrueColor,
    background: Background::Dark,
};

/// Opens a preset, paused at `step`.
fn at(preset: &str, set: &[&str], step: u64, size: Rect) -> Stage {
    let mut stage = Stage::open(preset, set, size);
    stage.commands(&format!("pause = true\ngo_to = {step}"));
    stage.settle().wait(0.5);
    while stage.lab.player().run().overlay_is_behind() {
        stage.wait(0.1);
    }
    stage
}

/// Draws the whole screen with colors.
fn colored(stage: &mut Stage) -> Buffer {
    stage.lab.view_mut().theme = COLORS;
    let mut buf = Buffer::empty(stage.size);
    screen::draw(&stage.lab, true, stage.size, &mut buf);
    buf
}

fn place(stage: &Stage, pane: Pane) -> Rect {
    let layout = screen::layout(&stage.lab, true, stage.size);
    layout.place_of(pane).unwrap()
}

fn overview(stage: &Stage) -> Rect {
    screen::layout(&stage.lab, true, stage.size).overview
}

/// Returns the cells of `area` with dots of `role`.
fn cells_of(role: Role, area: Rect, buf: &Buffer) -> Vec<(u16, u16)> {
    let color = COLORS.style(role).fg;
    let cells = area.positions().filter(|at| {
        let cell = &buf[*at];
        Some(cell.fg) == color && ('\u{2801}'..='\u{28ff}').contains(&first(cell.symbol()))
    });
    cells.map(|at| (at.x, at.y)).collect()
}

fn first(symbol: &str) -> char {
    symbol.chars().next().unwrap_or(' ')
}

/// Returns the area of the curves of each strip, found by the rule that begins with its name.
fn strips(area: Rect, buf: &Buffer) -> Vec<Rect> {
    let rules: Vec<u16> = (area.top()..area.bottom())
        .filter(|y| {
            let line: String = (area.left()..area.right())
                .map(|x| buf[(x, *y)].symbol())
                .collect();
            line.contains(") ─") || line.contains(") ━")
        })
        .collect();
    let ends = rules.iter().skip(1).copied().chain([area.bottom() - 1]);
    rules
        .iter()
        .zip(ends)
        .map(|(rule, end)| Rect::new(area.x, rule + 1, area.width, end - rule - 1))
        .collect()
}

/// Counts the peaks that touch the first row of `strip`.
fn peaks(strip: Rect, buf: &Buffer) -> usize {
    let is_dotted = |x: u16| {
        !matches!(
            first(buf[(x, strip.y)].symbol()),
            ' ' | '0'..='9' | '.' | '−'
        )
    };
    let columns: Vec<bool> = (strip.left()..strip.right()).map(is_dotted).collect();
    columns
        .chunk_by(|a, b| a == b)
        .filter(|stretch| stretch[0])
        .count()
}

#[test]
fn method_1_shows_separate_swings_in_every_strip() {
    for (size, swings) in [(SMALL, 4), (MEDIUM, 8), (LARGE, 8)] {
        let mut stage = at("method-1", &[], 2000, size);
        let buf = colored(&mut stage);
        let area = place(&stage, Pane::Traces);
        let strips = strips(area, &buf);
        assert!(strips.len() >= 3, "{size}\n{}", stage.picture());
        for strip in &strips[..3] {
            let count = peaks(*strip, &buf);
            assert!(
                count.abs_diff(swings) <= 1,
                "{size}: {count}\n{}",
                stage.picture()
            );
        }
        assert!(
            cells_of(Role::Fill, area, &buf).is_empty(),
            "{}",
            stage.picture()
        );
        let dots = cells_of(Role::Run, area, &buf).len();
        assert!(
            dots < area.area() as usize / 2,
            "{size}: {dots} of {}",
            area.area()
        );
    }
}

#[test]
fn method_2_is_smooth_at_a_short_time_step() {
    let mut stage = at(
        "method-2",
        &["motion.time_step_s=0.002", "motion.steps=115000"],
        115_000,
        MEDIUM,
    );
    let buf = colored(&mut stage);
    let area = place(&stage, Pane::Traces);
    assert!(
        cells_of(Role::Fill, stage.size, &buf).is_empty(),
        "{}",
        stage.picture()
    );
    let z = strips(area, &buf)[2];
    let rows = cells_of(Role::Run, z, &buf).into_iter().map(|(_, y)| y);
    let (top, bottom) = (rows.clone().min().unwrap(), rows.max().unwrap());
    assert!(bottom - top <= 1, "{}", stage.picture());
    // The strips show the whole run, in which x and y go through one circle.
    let window = &stage.lab.view().window;
    assert_eq!(
        (window.begin_s, window.end_s, window.has_overview),
        (0.0, 230.0, false)
    );
}

#[test]
fn unresolved_swings_are_drawn_as_an_envelope() {
    let mut stage = at("method-1", &[], 2000, MEDIUM);
    stage.press("w");
    assert!(!stage.lab.view().window.has_overview);
    let buf = colored(&mut stage);
    let strips = strips(place(&stage, Pane::Traces), &buf);
    for strip in strips {
        let fill = cells_of(Role::Fill, strip, &buf).len();
        assert!(
            fill > usize::from(strip.height) * 20,
            "{fill}\n{}",
            stage.picture()
        );
        for y in [strip.top(), strip.bottom() - 1] {
            let edge = cells_of(
                Role::Run,
                Rect {
                    y,
                    height: 1,
                    ..strip
                },
                &buf,
            )
            .len();
            assert!(edge > 35, "{edge}\n{}", stage.picture());
        }
    }
    // The swings are shown one by one again.
    stage.press("w");
    assert!(stage.lab.view().window.has_overview);
}

#[test]
fn a_fast_window_is_updated_once_per_second() {
    let mut stage = Stage::open("wobble-push", &[], SMALL);
    stage.wait(4.0);
    let shown = |of: &Stage| {
        let (area, picture) = (place(of, Pane::Traces), of.picture());
        let lines = picture.lines().skip(area.y.into()).take(area.height.into());
        let columns = lines.map(|line| line.chars().take(area.width.into()).collect::<String>());
        columns.collect::<Vec<_>>()
    };
    stage.shows("every 1 s");
    let pictures: Vec<_> = (0..20).map(|_| shown(stage.wait(0.1))).collect();
    let changes = pictures
        .windows(2)
        .filter(|pair| pair[0] != pair[1])
        .count();
    assert!((1..=2).contains(&changes), "{changes}");
    // Each window ends at a maximum of z, so that successive pictures match.
    let window = stage.lab.view().window;
    let recording = stage.lab.player().run().recording();
    let z = |begin_s, end_s| {
        recording
            .extent_between(begin_s, end_s, RecordedCurve::Z)
            .unwrap()
    };
    let last = z(window.end_s, window.end_s).max;
    let swing = z(window.end_s - window.swing_s.unwrap(), window.end_s);
    assert!(last > swing.max - 0.05 * (swing.max - swing.min));
    // When paused, the window contains the current time.
    stage.press(" ").shows_no("every 1 s");
    let now_s = stage.lab.player().run().now().time_s;
    assert!(stage.lab.view().window.contains(now_s));
}

#[test]
fn ranges_are_tight_and_labeled() {
    let mut stage = at("wobble-push", &[], 900, MEDIUM);
    let window = stage.lab.view().window;
    for curve in RecordedCurve::OF_POINT {
        let recording = stage.lab.player().run().recording();
        let shown = recording
            .extent_between(window.begin_s, 90.0, curve)
            .unwrap();
        assert_eq!(window.range(curve), shown);
        for end in [shown.min, shown.max] {
            stage.shows(&format!("{end:.3}").replace('-', "−"));
        }
    }
    for unit in ["x (m) ─", "y (m) ─", "z (m) ─"] {
        stage.shows(unit);
    }
}

#[test]
fn the_axis_of_a_run_with_few_swings_starts_at_0() {
    for (step, end_s) in [(0, 5.0), (4000, 5.0), (6000, 10.0), (10_000, 10.0)] {
        let stage = at("cusps", &[], step, MEDIUM);
        let window = &stage.lab.view().window;
        assert_eq!((window.begin_s, window.end_s), (0.0, end_s), "at {step}");
        assert!(!window.has_overview);
    }
}

#[test]
fn the_exact_motion_is_dashed_and_labeled() {
    let mut stage = at("wobble-push", &["view.exact=true"], 900, MEDIUM);
    let buf = colored(&mut stage);
    let area = place(&stage, Pane::Traces);
    for strip in &strips(area, &buf)[..3] {
        let exact = cells_of(Role::Exact, *strip, &buf);
        assert!(exact.len() >= 8, "{}", stage.picture());
        // A dashed line has at least one empty cell in three neighboring ones.
        let x: Vec<_> = exact.iter().map(|(x, _)| *x).collect();
        let longest = x
            .windows(3)
            .filter(|x| x[1] == x[0] + 1 && x[2] == x[1] + 1);
        assert_eq!(longest.count(), 0, "{}", stage.picture());
    }
    let picture = stage.picture();
    let named = picture
        .lines()
        .any(|line| line.chars().take(50).collect::<String>().contains("exact"));
    assert!(named, "{picture}");
}

#[test]
fn without_colors_the_exact_motion_has_its_own_character() {
    for (marker, sign) in [
        (Marker::HalfBlock, '─'),
        (Marker::Dot, '╌'),
        (Marker::Ascii, '-'),
    ] {
        let mut stage = at("wobble-push", &["view.exact=true"], 900, MEDIUM);
        (stage.lab.view_mut().marker, stage.lab.view_mut().theme) = (marker, Theme::PLAIN);
        let picture = stage.picture();
        // Only the curves, without rules and ticks.
        let lines = picture.lines().skip(2).take(28);
        let curves = lines.filter(|line| !line.contains("(m)"));
        let cells = curves.flat_map(|line| line.chars().take(50).skip(8));
        assert!(
            cells.filter(|cell| *cell == sign).count() >= 20,
            "{picture}"
        );
    }
}

/// The swing is known only after some steps; it stays known after a jump back to the start.
#[test]
fn jumping_back_to_the_start_keeps_the_overview() {
    let mut stage = at("method-2", &[], 900, MEDIUM);
    let before = stage.lab.view().window;
    assert!(before.has_overview);
    for step in [10, 0, 1] {
        stage.commands(&format!("go_to = {step}"));
        let window = stage.lab.view().window;
        assert!(window.has_overview, "at step {step}");
        assert_eq!(window.length_s(), before.length_s(), "at step {step}");
    }
}

#[test]
fn the_axis_of_the_distance_from_exact_has_no_negative_ticks() {
    let mut stage = at("falling", &["view.exact=true"], 9000, LARGE);
    let picture = stage.shows("off exact (m)").picture();
    let below = picture
        .lines()
        .skip_while(|line| !line.starts_with("off exact"));
    let ticks: String = below
        .take(11)
        .flat_map(|line| line.chars().take(10))
        .collect();
    assert!(ticks.contains("e−") && !ticks.contains(" −"), "{picture}");
}

#[test]
fn a_magnified_strip_points_to_the_exact_motion() {
    let mut stage = at("wobble-push", &["view.exact=true"], 900, MEDIUM);
    stage.press("zzz");
    let picture = stage.picture();
    assert!(picture.contains(['↑', '↓']), "{picture}");
    stage.press("ZZZ");
    assert_eq!(stage.lab.view().magnified, 1.0);
}

#[test]
fn the_cursor_is_a_line_through_every_strip_with_its_values() {
    let mut stage = at("wobble-push", &[], 900, MEDIUM);
    stage.commands("cursor = 863");
    let cursor = *stage.lab.player().cursor().unwrap();
    let buf = colored(&mut stage);
    let color = COLORS.style(Role::Cursor).fg;
    let area = place(&stage, Pane::Traces);
    let strips = strips(area, &buf);
    for (strip, curve) in strips.iter().zip(RecordedCurve::OF_POINT) {
        let columns = strip.columns().filter(|column| {
            column
                .positions()
                .all(|at| Some(buf[at].fg) == color && buf[at].symbol() != " ")
        });
        assert_eq!(columns.count(), 1, "{}", stage.picture());
        let rule: String = (area.left()..area.right())
            .map(|x| buf[(x, strip.y - 1)].symbol())
            .collect();
        let value = format!(" {:.3} ", curve.at(&cursor)).replace('-', "−");
        assert!(rule.contains(&value), "{value} in {rule}");
    }
    let overview = overview(&stage);
    let marked = cells_of(Role::Cursor, overview, &buf);
    assert!(
        marked.len() >= 2 || stage.picture().contains('│'),
        "{}",
        stage.picture()
    );
    stage.key(Key::Esc);
    assert_eq!(stage.lab.player().cursor(), None);
}

#[test]
fn the_overview_shows_window_push_and_edit() {
    let mut stage = at("wobble-push", &[], 900, MEDIUM);
    let area = overview(&stage);
    assert_eq!(area.height, 5);
    let picture = stage.picture();
    let lines: Vec<_> = picture.lines().skip(area.y.into()).take(5).collect();
    assert!(
        lines[0].contains("━ push ─") && lines[0].ends_with("whole run"),
        "{picture}"
    );
    assert!(
        lines[4].contains("0 s") && lines[4].contains("200"),
        "{picture}"
    );
    assert!(
        lines[1..4]
            .iter()
            .all(|line| line.contains('▕') && line.contains('▏')),
        "{picture}"
    );
    let buf = colored(&mut stage);
    let bright = cells_of(Role::Run, area, &buf);
    let dim = cells_of(Role::RunEarlier, area, &buf);
    assert!(!bright.is_empty() && dim.len() > bright.len());
    let left = |cells: &[(u16, u16)]| cells.iter().map(|(x, _)| *x).max();
    assert!(
        left(&dim) <= left(&bright),
        "nothing is drawn after the current time"
    );
}

#[test]
fn runs_with_few_swings_have_a_scrub_line_instead_of_the_overview() {
    let stage = at("cusps", &[], 4000, MEDIUM);
    let area = overview(&stage);
    assert_eq!(area.height, 1);
    let picture = stage.picture();
    let line = picture.lines().nth(area.y.into()).unwrap();
    assert!(
        line.starts_with("0 s ━") && line.contains("━┃─") && line.ends_with(" 10 s"),
        "{line}"
    );
}

#[test]
fn four_keys_zoom_and_capitals_reverse() {
    let mut stage = at("wobble-push", &[], 900, MEDIUM);
    let usual = stage.lab.view().window;
    stage.press("\t\t\t\t");
    stage.lab.turn_to(Pane::Traces);
    stage.press("[");
    assert!(stage.lab.view().window.end_s < usual.end_s);
    stage.press("]");
    let off_s = stage.lab.view().window.begin_s - usual.begin_s;
    assert!(off_s.abs() < 1e-9, "{off_s}");
    stage.press("20w");
    let swings = stage.lab.view().window.length_s() / usual.swing_s.unwrap();
    assert!((swings - 20.0).abs() < 0.5, "{swings}");
    stage.press("W");
    let again = stage.lab.view().window;
    assert_eq!((again.begin_s, again.end_s), (usual.begin_s, usual.end_s));
    stage.press("zz");
    assert_eq!(stage.lab.view().magnified, 4.0);
    stage.press("ZZ");
    assert_eq!(stage.lab.view().magnified, 1.0);
}

#[test]
fn the_wheel_zooms_about_the_pointer() {
    let mut stage = at("wobble-push", &[], 900, MEDIUM);
    let area = place(&stage, Pane::Traces);
    let (x, y) = (area.x + 20, area.y + 3);
    let time_s = |of: &Stage| {
        let window = &of.lab.view().window;
        let buf_width = f64::from(area.width) - 7.0;
        window.begin_s + (f64::from(x - area.x) - 6.5) / buf_width * window.length_s()
    };
    let before = (time_s(&stage), stage.lab.view().window.length_s());
    let mouse = |did| Mouse { did, x, y };
    Pointer::default().act(mouse(Did::WheelUp), stage.size, &mut stage.lab);
    stage.wait(0.0);
    let length_s = stage.lab.view().window.length_s();
    assert!((length_s - 0.5 * before.1).abs() < 1e-9);
    assert!(
        (time_s(&stage) - before.0).abs() < 0.05 * length_s,
        "the time under the pointer stays"
    );
    for _ in 0..10 {
        Pointer::default().act(mouse(Did::WheelDown), stage.size, &mut stage.lab);
        stage.wait(0.0);
    }
    assert!(!stage.lab.view().window.has_overview, "the whole run");
}

#[test]
fn a_click_on_the_overview_jumps_there() {
    let mut stage = at("wobble-push", &[], 900, MEDIUM);
    let area = overview(&stage);
    let press = Mouse {
        did: Did::Press,
        x: area.x + 8 + 25,
        y: area.y + 2,
    };
    Pointer::default().act(press, stage.size, &mut stage.lab);
    stage.wait(0.5);
    let now_s = stage.lab.player().run().now().time_s;
    assert!((now_s - 230.0 * 26.0 / 112.0).abs() < 4.0, "{now_s}");
}

#[test]
fn a_fourth_strip_shows_the_tilt_or_the_distance_from_exact() {
    let mut stage = at("wobble-push", &[], 900, LARGE);
    stage.shows("tilt (°) ─");
    stage.press("t").wait(1.0).shows("off exact (m) ─");
    stage.press("t");
    let mut small = at("wobble-push", &[], 900, SMALL);
    small
        .shows_no("tilt (°) ─")
        .press("j")
        .shows("tilt (°) ─")
        .shows_no("y (m) ─");
    small.press("jj").shows_no("tilt (°) ─").shows("y (m) ─");
}

#[test]
fn the_previous_run_is_dotted_behind_the_run() {
    let mut stage = at("wobble-push", &[], 900, MEDIUM);
    stage
        .commands("set = { 'start.momentum_Js' = [0, 0, 900] }")
        .wait(1.0);
    stage.commands("pause = true\ngo_to = 900");
    stage.settle();
    stage.shows("··· previous run");
    let buf = colored(&mut stage);
    let dots = cells_of(Role::Previous, place(&stage, Pane::Traces), &buf);
    assert!(dots.len() > 30, "{}", stage.picture());
}

#[test]
fn columns_show_the_extremes_of_their_steps() {
    let stage = at("wobble-push", &[], 2300, SMALL);
    let strip = Strip::new(0.0, 230.0, 50);
    let run = stage.lab.player().run();
    let columns = strip.bins(run.recording()).columns(RecordedCurve::Z, &[]);
    assert!(columns.iter().all(Option::is_some));
    for (index, column) in columns.iter().flatten().enumerate() {
        let time_s = strip.time_s(index);
        let inside = run
            .recording()
            .extent_between(time_s - 2.0, time_s + 2.0, RecordedCurve::Z)
            .unwrap();
        assert!(column.min <= inside.min + 1e-12 && inside.max <= column.max + 1e-12);
    }
}

#[test]
fn any_csv_column_can_be_shown_as_a_strip() {
    let mut stage = at("method-2", &[], 400, LARGE);
    stage.commands("detail_of = 'energy_J'").wait(1.0);
    stage.settle().shows("energy (J) ").shows_no("tilt (°)");
    let recorded = |shown: &Stage| {
        let column = shown.lab.comparison().column().unwrap();
        column.recording().whole().unwrap().samples()
    };
    assert_eq!(recorded(&stage), 401);
    // The column follows the run backward, and is recorded from the start for another run.
    stage.commands("go_to = 'start'\nstep = 3");
    stage.settle().wait(0.5);
    stage.press("/dt\n0.05\n").settle().wait(1.0);
    assert!(stage.lab.comparison().column().unwrap().before().is_some());
    stage.commands("detail_of = 'none'").shows_no("energy (J)");
    assert!(stage.lab.comparison().column().is_none());
}

#[test]
fn every_column_can_be_chosen_as_a_strip() {
    let of_run = QUANTITIES.iter().map(|quantity| quantity.name);
    let of_strips: Vec<_> = RecordedCurve::ALL.map(RecordedCurve::column).into();
    let others = of_run.filter(|name| !of_strips.contains(name));
    assert_eq!(others.collect::<Vec<_>>(), DETAILS[7..]);
    // j cycles through all of them.
    let mut stage = at("method-2", &[], 10, LARGE);
    let first = stage.lab.view().look.detail_of;
    for _ in 0..4 + DETAILS[7..].len() {
        stage.press("j");
    }
    assert_eq!(stage.lab.view().look.detail_of, first);
    stage.press("3j").press("jj").shows("Ly (J s) ");
}

#[test]
fn a_strip_keeps_its_chosen_range() {
    let mut stage = at("wobble-push", &["motion.time_step_s=0.002"], 100, LARGE);
    stage.commands("z_range_m = [0.5, 1]\ndetail_of = 'tilt'\ndetail_range = [0, 90]");
    stage.wait(1.0).shows("1.000").shows("0.500").shows("90.0");
    // Another column has its own range.
    stage.commands("detail_of = 'energy_J'");
    assert_eq!(stage.lab.view().look.detail_range, None);
    stage
        .commands("z_range_m = 'auto'")
        .wait(1.0)
        .shows_no("0.500");
}
