//! The views from above and in 3-D: what a reader must see at a glance.

use crate::support::stage::Stage;
use gyrolab::lab::view::View;
use gyrolab::lab::view::theme::{Background, Marker, Palette, Theme};
use gyrolab::tui::panes::PlotInputs;
use gyrolab::tui::panes::from_above::FromAbove;
use gyrolab::tui::panes::three_d::ThreeD;
use gyrolab::tui::theme::Role;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::widgets::Widget;
use std::ops::ControlFlow;

const COLORS: Theme = Theme {
    palette: Palette::TrueColor,
    background: Background::Dark,
};
/// The sizes of the panes on screens of 80x24, 120x40 and 200x50.
const SIZES: [(u16, u16); 3] = [(26, 16), (38, 15), (57, 30)];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Pane {
    Above,
    Space,
}

/// A drawn pane.
struct Picture(Buffer);

impl Picture {
    fn text(&self) -> String {
        let rows = self.0.content.chunks(self.0.area.width.into());
        rows.map(|row| row.iter().map(Cell::symbol).collect::<String>() + "\n")
            .collect()
    }

    fn symbol(&self, (x, y): (u16, u16)) -> char {
        self.0[(x, y)].symbol().chars().next().unwrap()
    }

    /// Returns the cells with dots or characters of `role` below the rule.
    fn cells(&self, role: Role) -> Vec<(u16, u16)> {
        let color = COLORS.style(role).fg;
        let cells = self.0.area.positions().filter(|at| at.y > 0);
        cells
            .filter(|at| Some(self.0[*at].fg) == color && self.0[*at].symbol() != " ")
            .map(|at| (at.x, at.y))
            .collect()
    }

    /// Returns the cells of `role` with dots.
    fn dots(&self, role: Role) -> Vec<(u16, u16)> {
        let mut cells = self.cells(role);
        cells.retain(|at| ('\u{2801}'..='\u{28ff}').contains(&self.symbol(*at)));
        cells
    }

    /// Returns the first cell of `label`.
    #[track_caller]
    fn label(&self, label: &str) -> (u16, u16) {
        let text = self.text();
        let mut rows = text.lines().zip(0..).skip(1);
        let found = rows.find_map(|(row, y)| {
            let before = row.split_once(label)?.0;
            Some((before.chars().count() as u16, y))
        });
        found.unwrap_or_else(|| panic!("no {label} in\n{text}"))
    }

    /// Asserts that `label` is within a few cells of dots of `role`.
    #[track_caller]
    fn is_labelled(&self, label: &str, role: Role) {
        let (x, y) = self.label(label);
        let reach = label.chars().count() as u16 + 3;
        let is_near = |at: &(u16, u16)| at.0.abs_diff(x) <= reach && at.1.abs_diff(y) <= 2;
        let dots = self.cells(role);
        assert!(
            dots.iter().any(is_near),
            "{label}: {dots:?}\n{}",
            self.text()
        );
    }
}

fn draw_view(pane: Pane, stage: &Stage, view: &View, (width, height): (u16, u16)) -> Picture {
    let mut buf = Buffer::empty(Rect::new(0, 0, width, height));
    let inputs = PlotInputs {
        view,
        ..PlotInputs::from_lab(&stage.lab)
    };
    match pane {
        Pane::Above => FromAbove(inputs).render(buf.area, &mut buf),
        Pane::Space => ThreeD(inputs).render(buf.area, &mut buf),
    }
    Picture(buf)
}

fn draw(pane: Pane, stage: &Stage, size: (u16, u16)) -> Picture {
    draw_view(pane, stage, stage.lab.view(), size)
}

/// Opens a paused lab with `preset` at `step`.
fn stage(preset: &str, step: u64, more: &str) -> Stage {
    let mut stage = Stage::open(preset, &[], Rect::new(0, 0, 120, 40));
    stage.commands(&format!("pause = true\ngo_to = {step}\n{more}"));
    stage.wait(0.5);
    while stage.lab.player().run().overlay_is_behind() {
        stage.wait(0.1);
    }
    stage
}

#[test]
fn the_view_from_above_labels_start_now_and_axes() {
    let stage = stage("method-2", 800, "");
    for size in SIZES {
        let picture = draw(Pane::Above, &stage, size);
        assert!(picture.text().starts_with("from above (m) "));
        picture.is_labelled("now", Role::Cursor);
        picture.is_labelled("start", Role::Label);
        for label in ["x", "y", "0.5", "−0.5"] {
            picture.label(label);
        }
        let (bright, dim) = (picture.dots(Role::Run), picture.dots(Role::RunEarlier));
        assert!(bright.len() >= 2 && dim.len() >= 8, "{}", picture.text());
        assert!(picture.cells(Role::Exact).is_empty());
    }
}

#[test]
fn the_exact_path_is_dashed_and_labeled_with_every_marker() {
    let stage = stage("wobble-push", 900, "exact = true");
    for size in SIZES {
        let picture = draw(Pane::Above, &stage, size);
        picture.is_labelled("exact", Role::Exact);
        let (exact, run) = (picture.dots(Role::Exact), picture.dots(Role::RunEarlier));
        assert!(exact.len() >= 10 && run.len() >= 10, "{}", picture.text());
        // In the smallest scene, both tops are in one cell.
        if size != SIZES[0] {
            let scene = draw(Pane::Space, &stage, size);
            assert!(!scene.dots(Role::Exact).is_empty(), "{}", scene.text());
        }
    }
    // If dots are as large as cells, a letter distinguishes it from the run without colors.
    let mut view = stage.lab.view().clone();
    for marker in [Marker::Dot, Marker::Ascii] {
        view.marker = marker;
        let picture = draw_view(Pane::Above, &stage, &view, SIZES[1]);
        let is_letter = |at: &(u16, u16)| picture.symbol(*at) == 'e';
        let letters = picture.cells(Role::Exact).into_iter().filter(is_letter);
        assert!(letters.count() >= 8, "{}", picture.text());
    }
}

#[test]
fn a_run_that_agrees_with_the_exact_motion_shows_both() {
    // The second run makes 200 turns on top of each other.
    for (preset, step, size) in [("cusps", 4000, SIZES[2]), ("method-1", 2000, SIZES[0])] {
        let stage = self::stage(preset, step, "exact = true");
        let picture = draw(Pane::Above, &stage, size);
        let of_run = [Role::Run, Role::RunEarlier].map(|role| picture.dots(role).len());
        let (exact, run) = (picture.dots(Role::Exact).len(), of_run[0] + of_run[1]);
        let text = picture.text();
        assert!(exact >= 12 && run >= 12, "{exact} and {run}\n{text}");
    }
}

/// A fast run is shown at its latest reading; the exact motion is marked at the same time.
#[test]
fn the_exact_motion_is_marked_at_the_shown_time() {
    let mut stage = Stage::open(
        "method-1",
        &["motion.scheme=exact"],
        Rect::new(0, 0, 120, 40),
    );
    stage.press("t").wait(0.3);
    for _ in 0..20 {
        stage.wait(0.13);
        let picture = draw(Pane::Above, &stage, SIZES[2]);
        let (now, exact) = (picture.label("now"), picture.label("exact"));
        let is_near = now.0.abs_diff(exact.0) <= 10 && now.1.abs_diff(exact.1) <= 3;
        assert!(is_near, "{}", picture.text());
    }
}

#[test]
fn a_run_that_covers_a_small_arc_shows_the_whole_circle() {
    let mut stage = stage("method-2-slow", 10_000, "");
    let picture = draw(Pane::Above, &stage, SIZES[1]);
    assert!(picture.dots(Role::Exact).len() >= 20, "{}", picture.text());
    picture.is_labelled("exact", Role::Exact);
    stage.commands("hide = ['predicted']");
    let hidden = draw(Pane::Above, &stage, SIZES[1]);
    assert!(hidden.cells(Role::Exact).is_empty(), "{}", hidden.text());
}

#[test]
fn the_cursor_is_marked_in_both_views() {
    let stage = stage("wobble-push", 900, "cursor = 863");
    for pane in [Pane::Above, Pane::Space] {
        for size in SIZES {
            draw(pane, &stage, size).label("◊");
        }
    }
}

#[test]
fn the_scale_from_above_is_constant_while_theory_holds() {
    for (preset, steps, most) in [
        ("method-2", 2300, 1),
        ("cusps", 6000, 1),
        ("wobble-push", 2300, 4),
    ] {
        let mut places = Vec::new();
        let mut stage = stage(preset, 0, "");
        for part in 0..=20 {
            stage.commands(&format!("go_to = {}", steps * part / 20));
            let picture = draw(Pane::Above, &stage, SIZES[1]);
            places.push(picture.dots(Role::Rule));
        }
        // The x axis is in the row with the most dots of its role.
        let rows: Vec<_> = places
            .iter()
            .map(|cells| {
                let of_row = |row: &u16| cells.iter().filter(|at| at.1 == *row).count();
                (1..SIZES[1].1).max_by_key(of_row)
            })
            .collect();
        let mut distinct = rows.clone();
        distinct.dedup();
        assert!(distinct.len() <= most, "{preset}: {rows:?}");
    }
}

#[test]
fn the_previous_and_the_pinned_run_are_labeled() {
    let mut stage = stage("method-2", 600, "pin = true");
    stage.commands("set = { 'start.tilt_deg' = 30 }\nset = { 'start.tilt_deg' = 60 }");
    stage.wait(2.0);
    for (pane, size) in [(Pane::Above, SIZES[2]), (Pane::Space, SIZES[2])] {
        let picture = draw(pane, &stage, size);
        picture.is_labelled("previous", Role::Previous);
        picture.is_labelled("pinned", Role::Previous);
    }
}

#[test]
fn the_arrows_have_their_letters_and_colors() {
    let arrows = [
        ("L", Role::AngularMomentum),
        ("Ω", Role::AngularVelocity),
        ("τ", Role::Torque),
    ];
    for (preset, step) in [
        ("method-2", 300),
        ("wobble-push", 900),
        ("cusps", 4000),
        ("falling", 10_000),
    ] {
        let stage = stage(preset, step, "");
        for size in SIZES {
            let picture = draw(Pane::Space, &stage, size);
            for (letter, role) in arrows {
                picture.is_labelled(letter, role);
                assert!(
                    picture.dots(role).len() >= 2,
                    "{letter}\n{}",
                    picture.text()
                );
            }
        }
    }
}

/// Returns the width and height of the drawing, relative to the area below the rule and above the legend.
fn filled_share(picture: &Picture, has_legend: bool) -> (f64, f64) {
    let area = picture.0.area;
    let legend = u16::from(has_legend);
    let drawn = area
        .positions()
        .filter(|at| at.y > 0 && at.y < area.height - legend && picture.0[*at].symbol() != " ");
    let (columns, rows): (Vec<_>, Vec<_>) = drawn.map(|at| (at.x, at.y)).unzip();
    let extent = |of: &[u16]| f64::from(of.iter().max().unwrap() - of.iter().min().unwrap() + 1);
    (
        extent(&columns) / f64::from(area.width),
        extent(&rows) / f64::from(area.height - 1 - legend),
    )
}

/// The volume swept in a whole turn fits in. At one time, the body fills most of the height, or of the width in small panes.
#[test]
fn the_scene_fills_its_pane() {
    for (preset, step) in [
        ("method-1", 2000),
        ("method-2", 900),
        ("wobble-push", 900),
        ("cusps", 4000),
        ("falling", 10_000),
    ] {
        let mut stage = stage(preset, 0, "");
        // The camera is turned to the axle, as when a lab opens at that step.
        stage
            .lab
            .begin_at(step, |_, _| ControlFlow::Continue(()))
            .unwrap();
        for (size, least) in SIZES.into_iter().zip([0.76, 0.78, 0.81]) {
            let picture = draw(Pane::Space, &stage, size);
            let (across, down) = filled_share(&picture, size.1 >= 18);
            let larger = across.max(down);
            assert!(
                larger >= least,
                "{preset} {size:?}: {across} {down}\n{}",
                picture.text()
            );
        }
    }
}

#[test]
fn the_scene_does_not_move_with_the_body() {
    let mut stage = stage("method-2", 0, "");
    let mut floors = Vec::new();
    for step in [0, 500, 1100, 1700, 2300] {
        stage.commands(&format!(
            "camera = {{ yaw_deg = 30, pitch_deg = 25 }}\ngo_to = {step}"
        ));
        let picture = draw(Pane::Space, &stage, SIZES[2]);
        let lowest = picture.dots(Role::Floor).iter().map(|at| at.1).max();
        floors.push(lowest);
    }
    floors.dedup();
    assert_eq!(floors.len(), 1, "{floors:?}");
}

#[test]
fn the_foot_of_a_heavy_body_is_on_the_floor() {
    let set = "camera = { yaw_deg = 0, pitch_deg = 10 }";
    let mut free = Stage::open(
        "method-2",
        &["motion.gravity_m_per_s2=0"],
        Rect::new(0, 0, 120, 40),
    );
    free.commands(&format!("pause = true\n{set}"));
    let picture = draw(Pane::Space, &free, SIZES[2]);
    let columns = |cells: &[(u16, u16)], x: u16| cells.iter().filter(|at| at.0 == x).count();
    let middle = SIZES[2].0 / 2;
    let stage = stage("method-2", 300, set);
    let heavy = draw(Pane::Space, &stage, SIZES[2]);
    assert!(
        columns(&heavy.dots(Role::RimFar), middle) >= 3,
        "{}",
        heavy.text()
    );
    assert!(
        columns(&picture.dots(Role::RimFar), middle) < 3,
        "{}",
        picture.text()
    );
    assert!(picture.text().contains("no torque"), "{}", picture.text());
}

#[test]
fn near_masses_are_larger_than_far_ones() {
    let set = ["start.tilt_deg=0", "start.momentum_Js=[0, 0, 1000]"];
    let mut stage = Stage::open("method-2", &set, Rect::new(0, 0, 120, 40));
    stage.commands("pause = true\ncamera = { yaw_deg = 0, pitch_deg = 30 }");
    let picture = draw(Pane::Space, &stage, SIZES[2]);
    // Seen from above, the near half of a level wheel is the lower one.
    let rows = |role| {
        picture
            .dots(role)
            .into_iter()
            .map(|at| at.1)
            .collect::<Vec<_>>()
    };
    let (near, far) = (rows(Role::RimNear), rows(Role::RimFar));
    let of_far_rim = far
        .iter()
        .filter(|row| *row < near.iter().max().unwrap())
        .count();
    assert!(
        near.iter().min() >= far.iter().min() && of_far_rim >= 5,
        "{}",
        picture.text()
    );
    let dots = |at: &(u16, u16)| (u32::from(picture.symbol(*at)) - 0x2800).count_ones();
    let largest = |role| picture.dots(role).iter().map(dots).max();
    assert!(
        largest(Role::Text) >= largest(Role::RimFar),
        "{}",
        picture.text()
    );
}

#[test]
fn strokes_are_letters_without_colors_and_braille() {
    let stage = stage("method-2", 300, "");
    let mut view = stage.lab.view().clone();
    (view.marker, view.theme) = (Marker::Ascii, Theme::PLAIN);
    let text = draw_view(Pane::Space, &stage, &view, SIZES[2]).text();
    for (sign, least) in [('L', 5), ('W', 3), ('T', 2), ('#', 8), ('.', 20)] {
        assert!(text.matches(sign).count() >= least, "{sign}\n{text}");
    }
}

#[test]
fn an_acting_push_is_shown_as_an_arrow() {
    let stage = stage("wobble-push", 120, "");
    for pane in [Pane::Above, Pane::Space] {
        draw(pane, &stage, SIZES[2]).label("F");
    }
    let over = self::stage("wobble-push", 201, "");
    for pane in [Pane::Above, Pane::Space] {
        assert!(!draw(pane, &over, SIZES[2]).text().contains(" F"));
    }
}

/// Returns the number of dot columns and dot rows between the outermost dots of `role`.
fn extent(picture: &Picture, role: Role) -> (usize, usize) {
    const ACROSS: [usize; 8] = [0, 0, 0, 1, 1, 1, 0, 1];
    const DOWN: [usize; 8] = [0, 1, 2, 0, 1, 2, 3, 3];
    let dots = picture.dots(role).into_iter().flat_map(|(x, y)| {
        let bits = u32::from(picture.symbol((x, y))) - 0x2800;
        let set = (0..8).filter(move |bit| bits >> bit & 1 == 1);
        set.map(move |bit| {
            (
                2 * usize::from(x) + ACROSS[bit],
                4 * usize::from(y) + DOWN[bit],
            )
        })
    });
    let (columns, rows): (Vec<_>, Vec<_>) = dots.unzip();
    let length = |of: &[usize]| of.iter().max().unwrap() - of.iter().min().unwrap();
    (length(&columns), length(&rows))
}

#[test]
fn circles_are_round_to_within_two_dots() {
    // A turn takes 0.691 s.
    let mut stage = stage("torque-free", 700, "");
    for zoom in [1.0, 0.5] {
        stage.commands(&format!("zoom = {{ above = {zoom:?} }}"));
        for size in [(36, 19), (80, 20), (47, 23), (30, 40)] {
            let picture = draw(Pane::Above, &stage, size);
            let text = picture.text();
            let (across, down) = extent(&picture, Role::Run);
            assert!(across.abs_diff(down) <= 2, "{across} by {down}\n{text}");
            let room = f64::from((2 * size.0).min(4 * (size.1 - 1))) * zoom;
            assert!(down as f64 > 0.8 * room - 4.0, "{down} of {room}\n{text}");
        }
    }
}

#[test]
fn a_circle_about_a_constant_momentum_fills_the_picture() {
    let picture = draw(Pane::Above, &stage("method-1", 1000, ""), SIZES[2]);
    let (across, down) = extent(&picture, Role::Run);
    assert!(
        across.max(down) >= 90,
        "{across} by {down}\n{}",
        picture.text()
    );
}

#[test]
fn the_current_position_is_visible_at_every_zoom() {
    for step in [0, 150, 333, 600] {
        let mut stage = stage("wobble-push", step, "");
        for zoom in [0.5, 1.0, 2.0, 5.0, 100.0] {
            stage.commands(&format!("zoom = {{ above = {zoom:?} }}"));
            let picture = draw(Pane::Above, &stage, SIZES[0]);
            let dots = picture.dots(Role::Cursor);
            assert!(!dots.is_empty(), "{step} x{zoom}\n{}", picture.text());
        }
    }
}
