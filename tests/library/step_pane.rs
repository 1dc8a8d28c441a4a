//! The step pane: a time step phase by phase, with the numbers of the run.

use crate::support::scenarios::{parse, preset, resumed};
use crate::support::stage::{LARGE, SMALL, Stage};
use crate::support::words::{has, has_all, has_no};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::Document;
use gyrolab::lab::view::Pane;
use gyrolab::lab::view::step::StepPageChoice;
use gyrolab::physics::scheme::SCHEMES;
use gyrolab::physics::workings::{ColumnSums, Phase, WorkedValue};
use gyrolab::tui::keymap::Key;
use gyrolab::tui::screen;
use ratatui::layout::Rect;
use std::sync::Arc;

const WIDE: Rect = Rect {
    x: 0,
    y: 0,
    width: 120,
    height: 40,
};

/// Returns the phases of the first step of method-2.
fn first_step() -> Vec<Phase> {
    let mut run = Simulation::new(Arc::new(preset("method-2", &[])));
    run.keep_workings(true);
    let workings = run.step().unwrap().workings().cloned().unwrap();
    workings.phases().cloned().collect()
}

/// Returns every number of `phase` under `symbol`, row by row.
fn numbers(phase: &Phase, symbol: &str) -> Vec<f64> {
    match phase.value(symbol).unwrap() {
        WorkedValue::Number(number) => vec![*number],
        WorkedValue::Vector(vector) => vector.iter().copied().collect(),
        WorkedValue::Matrix(matrix) => matrix.transpose().iter().copied().collect(),
        WorkedValue::Table(table) => table.cells.clone(),
    }
}

/// Returns the picture of `pane` alone.
fn picture_of(stage: &Stage, pane: Pane) -> String {
    let layout = screen::layout(&stage.lab, true, stage.size);
    let place = layout.place_of(pane).expect("the pane is on the screen");
    let picture = stage.picture();
    let rows = picture
        .lines()
        .skip(place.y.into())
        .take(place.height.into());
    rows.map(|row| {
        let cells = row.chars().skip(place.x.into()).take(place.width.into());
        cells.collect::<String>() + "\n"
    })
    .collect()
}

/// Returns the panes on the screen.
fn panes(stage: &Stage) -> Vec<Pane> {
    let layout = screen::layout(&stage.lab, true, stage.size);
    layout.panes.iter().map(|(pane, _)| *pane).collect()
}

/// Returns the numbers after `symbol` in the picture of the pane.
#[track_caller]
fn printed(stage: &Stage, symbol: &str) -> Vec<String> {
    let picture = picture_of(stage, Pane::Step);
    let start = format!("{symbol} ");
    let line = picture.lines().find_map(|line| line.strip_prefix(&start));
    let rest = line.unwrap_or_else(|| panic!("no {symbol} in\n{picture}"));
    let words = rest.split_whitespace();
    let numbers = words.filter(|word| word.parse::<f64>().is_ok());
    numbers.map(str::to_owned).collect()
}

#[test]
fn the_shown_numbers_equal_those_of_the_run() {
    for size in [SMALL, LARGE] {
        let mut stage = Stage::open("wobble-push", &[], size);
        stage.commands("show = ['3d', 'step']\ngo_to = 12\nphase = 'new momentum'");
        let sample = stage.lab.player().run().simulation().sample();
        let shown = printed(&stage, "new L");
        assert_eq!(shown.len(), 3);
        for (digits, exact) in shown.iter().zip(sample.momentum.iter()) {
            let decimals = digits.split_once('.').map_or(0, |(_, behind)| behind.len());
            assert_eq!(*digits, format!("{exact:.decimals$}"));
            assert!(decimals >= 3, "six digits of 707");
        }
        stage.commands("phase = 'new positions'\nsum_to = 12");
        let picture = picture_of(&stage, Pane::Step);
        let rows = picture.lines().skip_while(|line| !line.starts_with("top "));
        let words = rows.take(2).flat_map(str::split_whitespace);
        let positions: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
        for (printed, exact) in positions[3..6].iter().zip(sample.position.iter()) {
            assert!((printed - exact).abs() < 1e-4, "{printed} for {exact}");
        }
    }
}

#[test]
fn the_rows_add_up_to_the_sums_of_the_scheme() {
    let phases = first_step();
    let Some(WorkedValue::Table(points)) = phases[0].value("X") else {
        panic!("a table")
    };
    let sums = ColumnSums::from_table(points).first(points, 14);
    let s = numbers(&phases[0], "S");
    // xx, yy, zz, xy, xz, yz
    assert_eq!(sums[4..], [s[0], s[4], s[8], s[1], s[2], s[5]]);
    let Some(WorkedValue::Table(moments)) = phases[5].value("m X") else {
        panic!("a table")
    };
    let moment_sums = ColumnSums::from_table(moments).first(moments, 14);
    assert_eq!(moment_sums, numbers(&phases[5], "Σ m X"));
}

/// Returns the step, the number of the shown phase and the number of phases.
#[track_caller]
fn place(stage: &Stage) -> (u64, usize, usize) {
    let lab = &stage.lab;
    let explained = lab.step_pane().shown().expect("a step that is shown");
    let (_, number, count) = explained.phase(lab.view().look.phase).expect("a phase");
    assert_eq!(explained.step, stage.step());
    (explained.step, number, count)
}

#[test]
fn v_toggles_the_step_pane() {
    for size in [SMALL, LARGE] {
        let mut stage = Stage::open("method-2", &[], size);
        stage.commands("pause = true");
        let before = panes(&stage);
        stage.press("v");
        assert_eq!(stage.focus(), "step");
        stage.shows("No time step has been taken yet");
        if size == LARGE {
            assert_eq!(panes(&stage), [Pane::Step, Pane::ThreeD, Pane::Traces]);
        } else {
            assert_eq!(panes(&stage), [Pane::Step]);
            stage.press("\t\t");
            assert_eq!(panes(&stage), [Pane::ThreeD]);
            stage.press("\t");
        }
        stage.press("v");
        assert_eq!(panes(&stage), before);
        stage.press("v\u{1b}");
        assert_eq!(panes(&stage), before, "Esc closes it too");
        // This also works from a full-screen pane.
        stage.press("fv");
        assert_eq!(stage.focus(), "step");
        stage.press("f");
        assert_eq!(panes(&stage), [Pane::Step]);
        stage.press("v");
        assert_eq!(panes(&stage), before);
    }
}

#[test]
fn the_keys_move_by_phase_and_on_to_the_next_step() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.commands("pause = true").press("v,");
    stage.shows("the run begins here");
    stage.press(".");
    assert_eq!(place(&stage), (1, 1, 7));
    stage.press("...");
    assert_eq!(place(&stage), (1, 4, 7));
    stage.shows("step 0 → 1").shows("phase 4 of 7");
    stage.shows(" 4 rotation ").press(",");
    assert_eq!(place(&stage), (1, 3, 7));
    stage.press("....");
    assert_eq!(place(&stage), (1, 7, 7));
    stage.press(".");
    assert_eq!(place(&stage), (2, 1, 7));
    stage.press(",");
    assert_eq!(place(&stage), (1, 7, 7));
    stage.press("15.");
    assert_eq!(place(&stage), (4, 1, 7), "7 + 15 = 3 * 7 + 1");
    stage.press("8,");
    assert_eq!(place(&stage), (2, 7, 7));
    stage.press("99,");
    assert_eq!(stage.step(), 0);
    stage.shows("No time step has been taken yet");
    // Without the focus, the keys advance by time steps as usual.
    stage.press(".\t..");
    assert_eq!(stage.step(), 3);
    // While the run plays, the keys pause it first.
    stage.press("\t ");
    stage.wait(1.0).press(".");
    assert!(!stage.lab.player().is_running());
    assert_eq!(place(&stage).1, 1);
}

#[test]
fn points_can_be_added_up_one_by_one() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.commands("pause = true").press("v.");
    stage.shows("10 more: press Down to add them up");
    stage.press("↓").shows("the first of 14 points gives");
    stage.press("↓↓");
    stage.shows("the first 3 of 14 points add up to");
    stage.press("↑").shows("the first 2 of 14");
    stage.key(Key::PageDown);
    stage.shows("the first 12 of 14").shows("top");
    stage.press("↓↓").shows("the first 14 of 14");
    stage.press("↓").shows_no("add up to");
    stage.press("↑").shows("the first 13 of 14");
    // Another phase shows all its rows.
    stage.press(".").shows_no("add up to");
    stage.press("↓").shows("no table here");
}

#[test]
fn the_selected_point_is_expanded_and_massless_points_share_a_row() {
    let mut stage = Stage::open("method-2", &[], WIDE);
    stage.commands("pause = true\nstep = 3").press("v");
    stage.commands("phase = 'torque'");
    stage.shows("hub, top, foot, lower axle: no mass");
    stage.press("↓↓");
    let shown = stage.lab.step_pane().shown().unwrap();
    let (phase, ..) = shown.phase(stage.lab.view().look.phase).unwrap();
    let table = gyrolab::lab::step_pane::table_of(phase).unwrap();
    let [x, y, _] = table.row(1).to_owned()[..] else {
        panic!("three columns")
    };
    let short = |number| gyrolab::engine::text::number::significant(number, 4);
    for (axis, product) in [("x", x), ("y", y)] {
        let place = short(product / 0.5);
        stage.shows(&format!(
            "m {axis} = 0.5 · {place} = {} kg m",
            short(product)
        ));
    }
    stage.shows("rim 1: ").shows("hub, top, foot");
    // Every massless point can be selected.
    stage.commands("sum_to = 12");
    stage.shows("top has no mass").shows_no("hub, top, foot");
    stage.commands("phase = 'new momentum'");
    stage.shows("L turns by ").shows("sideways, not down");
}

#[test]
fn commands_and_files_control_the_step_pane() {
    let set = ["view.show=['step', 'above']", "view.phase='torque'"];
    let mut stage = Stage::open("method-2", &set, WIDE);
    stage.commands("pause = true\nstep = 3");
    stage
        .shows("from above (m)")
        .shows("step 2 → 3")
        .shows("phase 6 of 7");
    stage.commands("phase = 2");
    stage.shows("phase 2 of 7").shows(" 2 Ω ");
    stage.commands("phase = 'last'").shows("phase 7 of 7");
    stage.commands("phase = 'why'");
    stage.shows("why sideways, not down?");
    stage.commands("fill = 'step'\nphase = 1\nsum_to = 4");
    stage.shows("the first 4 of 14");
    stage.shows_no("from above");
    stage.commands(
        "set = { 'motion.scheme' = 'rk4' }\nstep = 1\nphase = 'slope 1: at the beginning'",
    );
    stage.shows("step 3 → 4").shows("phase 1 of 6");
    let rk4 = ["view.fill='step'", "motion.scheme='rk4'"];
    let mut filled = Stage::open("method-2", &rk4, SMALL);
    filled.commands("pause = true\nstep = 2");
    filled.shows("step 1 → 2").shows("phase 1 of 6");
    let command = crate::support::desk::commands("phase = 'torque'");
    let refused = filled.lab.carry_out(&command[0]).unwrap_err().to_string();
    has(&refused, "rk4 has no phase torque: it has slope 1");
}

#[test]
fn why_returns_to_the_previous_page() {
    let mut stage = Stage::open("cusps", &[], SMALL);
    stage.commands("pause = true\nstep = 300").press("v...");
    let place = stage.lab.view().look.phase;
    assert!(matches!(place, StepPageChoice::Number(2..)));
    stage.shows(". next phase").shows("y why sideways");
    stage.press("y").shows("not down?").shows("first dip");
    stage.shows(". next step").shows("y phases");
    stage.press("y");
    assert_eq!(stage.lab.view().look.phase, place);
}

#[test]
fn a_dip_of_the_size_of_rounding_is_ignored() {
    let mut stage = Stage::open("cusps", &["motion.scheme='report'"], SMALL);
    stage.commands("pause = true\nstep = 1\nshow = ['step', '3d']\nphase = 'why'");
    stage.shows("no motion yet").commands("step = 200");
    stage.shows_no("no motion yet").shows(" m ");
    stage.shows("so far");
}

#[test]
fn why_describes_the_acting_forces() {
    for (preset, set, words) in [
        ("cusps", "motion.scheme='report'", "The forces pull down"),
        ("torque-free", "motion.scheme='report'", "No torque acts"),
        ("first-dip", "motion.scheme='rk4'", "which is not along τ"),
        ("wobble-push", "push.0.force_N=[50, 0, 0]", "X × F square"),
        (
            "wobble-push",
            "push.0.force_N=[0, 0, -5]",
            "The forces pull down",
        ),
    ] {
        let mut stage = Stage::open(preset, &[set], SMALL);
        stage.commands("pause = true\nstep = 5\nshow = ['step', '3d']\nphase = 'why'");
        stage.shows(words);
    }
}

#[test]
fn the_slope_of_the_momentum_mentions_friction_if_present() {
    for (preset, is_rubbed) in [("first-dip", true), ("cusps", false)] {
        let mut stage = Stage::open(preset, &["motion.scheme='rk4'"], LARGE);
        stage.commands("pause = true\nstep = 5\nfill = 'step'\nphase = 1");
        stage.shows("L₁′ = τ(Q)");
        assert_eq!(stage.picture().contains("friction's torque"), is_rubbed);
    }
}

#[test]
fn every_phase_of_every_scheme_has_a_page() {
    for scheme in SCHEMES {
        for preset in ["wobble-push", "cusps"] {
            let set = format!("motion.scheme='{}'", scheme.name);
            let mut stage = Stage::open(preset, &[&set], SMALL);
            stage.commands("pause = true\nstep = 2\nshow = ['step', '3d']");
            let workings = Arc::clone(&stage.lab.step_pane().shown().unwrap().workings);
            let count = workings.phases().count();
            for index in 0..count {
                stage.commands(&format!("phase = {}", index + 1));
                let place = format!("phase {} of {count}", index + 1);
                stage.shows("step 1 → 2").shows(&place);
            }
        }
    }
}

#[test]
fn the_step_pane_is_drawn_at_every_size() {
    let mut stage = Stage::open("wobble-push", &[], SMALL);
    stage.commands("pause = true\nstep = 5\nshow = ['step', '3d']\nsum_to = 5");
    for page in ["1", "3", "5", "6", "'why'"] {
        for sum in ["'all'", "9"] {
            stage.commands(&format!("phase = {page}\nsum_to = {sum}"));
            let tiny = [(0, 0), (1, 1), (5, 3), (12, 40)];
            let usual = [(40, 12), (52, 18), (70, 24), (300, 90)];
            for (width, height) in tiny.into_iter().chain(usual) {
                stage.size = Rect::new(0, 0, width, height);
                screen::fit(&mut stage.lab, stage.size);
                stage.picture();
            }
        }
    }
}

#[test]
fn the_step_pane_has_a_fixed_share_of_the_screen() {
    let widths = |stage: &Stage| -> Vec<(&'static str, u16)> {
        let panes = screen::layout(&stage.lab, true, stage.size).panes;
        let widths = panes.iter().map(|(pane, place)| (pane.id(), place.width));
        widths.collect()
    };
    let mut stage = Stage::open("method-2", &["view.show=['above', '3d', 'step']"], SMALL);
    stage.commands("pause = true");
    // Its tables need all 80 columns; Tab switches to the run.
    assert_eq!(widths(&stage), [("step", 80)]);
    stage.press("\t");
    let beside = stage.focus();
    assert_eq!(widths(&stage), [(beside, 80)]);
    for (width, panes) in [
        (60, vec![(beside, 60)]),
        (40, vec![(beside, 40)]),
        (120, vec![("step", 74), ("above", 21), ("3d", 22)]),
        (200, vec![("step", 84), ("above", 56), ("3d", 57)]),
    ] {
        stage.size.width = width;
        assert_eq!(widths(&stage), panes);
    }
}

#[test]
fn a_phase_shows_its_own_arrows_in_3d() {
    let set = ["motion.scheme='report'", "motion.time_step_s=0.2"];
    let mut stage = Stage::open("falling", &set, LARGE);
    stage.commands("pause = true\nstep = 2\nshow = ['3d', 'step']");
    for (page, shown, hidden) in [
        (2, "Ω angular velocity|L angular momentum", "torque|u axis"),
        (3, "u axis of rotation", "L angular|before"),
        (5, "gray: before the step", "L angular"),
        (6, "τ torque|weight", "L angular|Ω angular"),
        (7, "L angular momentum|dL = dt τ|new L|as long", "Ω angular"),
    ] {
        stage.commands(&format!("phase = {page}"));
        let scene = picture_of(&stage, Pane::ThreeD);
        has_all(&scene, shown.split('|'));
        hidden.split('|').for_each(|words| has_no(&scene, words));
    }
    // Without the step pane, the 3-D view shows the usual arrows.
    stage.commands("show = ['3d', 'above']");
    let scene = picture_of(&stage, Pane::ThreeD);
    has_all(
        &scene,
        ["L angular momentum", "Ω angular velocity", "τ torque"],
    );
    has_no(&scene, "dL");
}

#[test]
fn with_friction_the_change_of_momentum_is_not_along_the_torque() {
    let mut stage = Stage::open("first-dip", &["motion.scheme='rk4'"], LARGE);
    stage.commands("pause = true\nstep = 5\nshow = ['3d', 'step']\nphase = 7");
    let scene = picture_of(&stage, Pane::ThreeD);
    has(&scene, "dL with friction");
    has_no(&scene, "= dt τ");
}

#[test]
fn a_body_with_100_000_points_is_shown() {
    let scenario = parse(
        "title = 'x'\n[body.rim]\npoints = 99999\nradius_m = 0.8\nheight_m = 0.5\npoint_mass_kg = 0.00005\n\
         [[body.point]]\nname = 'top'\nat_m = [0, 0, 1]\n[start]\ntilt_deg = 30\nmomentum_Js = [0, 0, 100]\n\
         [motion]\ntime_step_s = 0.01\nsteps = 9\n",
    );
    let view = crate::support::scenarios::view(
        &scenario,
        gyrolab::lab::view::theme::Marker::Braille,
        true,
    );
    let mut lab = gyrolab::lab::Lab::new("x", Arc::new(scenario), view, false);
    screen::fit(&mut lab, SMALL);
    for command in crate::support::desk::commands("show = ['step', '3d']\nstep = 1\nsum_to = 60000")
    {
        lab.carry_out(&command).unwrap();
    }
    let picture = screen::text(&lab, true, (80, 24));
    has(&picture, "the first 60000 of 100000 points");
    let mut rows = picture.lines();
    assert!(rows.any(|row| row.starts_with("59999 ")), "{picture}");
}

#[test]
fn the_step_pane_is_restored_with_the_session() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.commands("pause = true\nstep = 4").press("v....");
    stage.commands("phase = 'torque'\nsum_to = 3");
    let content = stage.lab.content(&Default::default());
    let mut lab = resumed(&content);
    screen::fit(&mut lab, SMALL);
    lab.take_changed();
    let picture = screen::text(&lab, true, (80, 24));
    has_all(&picture, ["phase 6 of 7", "the first 3 of 14"]);
    assert_eq!(lab.view().focus.id(), "step");
}

#[test]
fn a_file_may_set_the_page_of_the_step_pane() {
    let text = "title = 'x'\n[view]\nphase = 3\nsum_to = 'all'\nshow = ['step', 'above']";
    let document = Document::parse("x.toml", text).unwrap();
    let told = document.scenario().unwrap_err().to_string();
    assert!(!told.contains("view"), "{told}");
}

#[test]
fn pages_of_the_step_pane_match_their_snapshots() {
    let pages = [
        ("inertia", "phase = 1"),
        ("inertia_adds_up", "phase = 1\nsum_to = 4"),
        ("axis", "phase = 3"),
        ("positions", "phase = 5\nsum_to = 3"),
        ("torque", "phase = 6"),
        ("momentum", "phase = 7"),
    ];
    for (size, name) in [(SMALL, "small"), (LARGE, "large")] {
        let mut stage = Stage::open("wobble-push", &[], size);
        stage.commands("pause = true\nstep = 12\nshow = ['3d', 'step']");
        // Only tables look different on a large screen, so one page of them is enough.
        let shown = if size == SMALL {
            &pages[..]
        } else {
            &pages[1..2]
        };
        for (page, commands) in shown {
            stage.commands(commands);
            insta::assert_snapshot!(format!("{page}_{name}"), stage.picture());
        }
        let mut cusps = Stage::open("cusps", &["motion.scheme='srkn11b'"], size);
        cusps.commands("pause = true\nstep = 900\nshow = ['3d', 'step']\nphase = 'why'");
        insta::assert_snapshot!(format!("why_{name}"), cusps.picture());
        if size == SMALL {
            cusps.commands("phase = 2");
            insta::assert_snapshot!("splitting_small", cusps.picture());
        }
    }
}
