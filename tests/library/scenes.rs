//! What the round pictures show of a run: from where, beside which other runs, and after a scheme broke down.

use crate::support::stage::{LARGE, SMALL, Stage};
use gyrolab::lab::view::Pane;
use gyrolab::plot::camera::Camera;
use gyrolab::tui::keymap::Key;
use gyrolab::tui::screen;
use ratatui::layout::Rect;

/// The length of the axle in the picture, of its own.
fn axle_in_picture(stage: &Stage) -> f64 {
    let axle = stage.lab.player().run().simulation().state().axle();
    let (right, up) = stage.lab.view().camera.project(&axle);
    right.hypot(up)
}

#[test]
fn a_still_picture_shows_the_axle_aslant() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.commands("pause = true");
    let mut cameras = vec![stage.lab.view().camera];
    for step in (0..2300).step_by(100) {
        stage.commands(&format!("go_to = {step}"));
        assert!(axle_in_picture(&stage) > 0.7, "step {step}");
        cameras.push(stage.lab.view().camera);
    }
    cameras.dedup();
    assert!((2..=14).contains(&cameras.len()), "{cameras:?}");
    // What was chosen stays.
    stage.press("d→");
    let chosen = stage.lab.view().camera;
    for step in (0..2300).step_by(100) {
        stage.commands(&format!("go_to = {step}"));
        assert_eq!(stage.lab.view().camera, chosen);
    }
    // The usual direction is no choice.
    stage.commands("camera = { yaw_deg = 30, pitch_deg = 20 }\ngo_to = 0");
    assert_ne!(stage.lab.view().camera, chosen);
    assert!(axle_in_picture(&stage) > 0.7);
}

#[test]
fn a_moving_picture_keeps_its_direction() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.wait(0.2);
    let camera = stage.lab.view().camera;
    let mut shortest = 1.0f64;
    for _ in 0..100 {
        stage.wait(0.1);
        assert_eq!(stage.lab.view().camera, camera);
        shortest = shortest.min(axle_in_picture(&stage));
    }
    assert!(
        shortest < 0.6,
        "it points at the eye on its way: {shortest}"
    );
}

/// The picture of the 3-D view, without its legend.
fn scene(stage: &Stage) -> String {
    let picture = stage.picture();
    let above_legend = picture.split("L angular momentum").next();
    above_legend.unwrap_or_default().to_owned()
}

#[test]
fn the_pinned_run_and_the_one_before_are_drawn_in_space() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.commands("pause = true\ngo_to = '60 s'\npin = true\nset = { 'start.tilt_deg' = 30 }");
    stage.commands("set = { 'start.tilt_deg' = 60 }");
    stage.press("d");
    stage.shows("pinned").shows("dotted: other");
    let both = scene(&stage);
    stage.commands("pin = false");
    stage.shows_no("pinned").shows("dotted: other");
    assert_ne!(scene(&stage), both);
}

#[test]
fn after_a_scheme_broke_down_the_last_whole_body_is_shown() {
    let set = ["motion.scheme=rk4", "motion.time_step_s=0.03"];
    let mut stage = Stage::open("method-2", &set, LARGE);
    stage.wait(2.0).shows("no longer finite at step 31");
    stage.shows("from above at step 29: then the scheme broke down");
    stage.shows("3-D at step 29: then the scheme broke down");
    let state = stage.lab.player().reading.state;
    assert!(state.is_a_rotation() && (state.time_s - 0.87).abs() < 1e-9);
    assert!(
        !stage
            .lab
            .player()
            .run()
            .simulation()
            .state()
            .is_a_rotation()
    );
    stage.commands("go_to = 29").shows_no("broke down");
    stage.commands("go_to = 30");
    stage.shows("3-D at step 29: then the scheme broke down");
    stage.commands("go_to = 3").shows_no("broke down");
    assert_eq!(
        stage.lab.player().reading.state,
        *stage.lab.player().run().simulation().state()
    );
    // In a narrow pane the title is shorter, and whole.
    let mut small = Stage::open("method-2", &set, SMALL);
    small.wait(2.0).shows(" from above, step 29 ");
}

#[test]
fn at_120_columns_the_round_pictures_share_a_column() {
    let stage = Stage::open("method-2", &[], Rect::new(0, 0, 120, 40));
    let layout = screen::layout(&stage.lab, true, stage.size);
    let place = |wanted: Pane| {
        let mut panes = layout.panes.iter();
        panes.find(|(pane, _)| *pane == wanted).unwrap().1
    };
    let (above, space, traces) = (place(Pane::Above), place(Pane::ThreeD), place(Pane::Traces));
    assert_eq!(
        (above.x, above.width, above.bottom()),
        (space.x, space.width, space.y)
    );
    assert!(traces.width > 45 && above.width > 36, "{layout:?}");
}

#[test]
fn keys_and_commands_turn_the_camera_from_where_it_is() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.commands("pause = true").press("d");
    let before = stage.lab.view().camera;
    stage.key(Key::Right);
    let after = stage.lab.view().camera;
    assert_eq!(
        after,
        Camera {
            yaw_deg: (before.yaw_deg + 10.0).rem_euclid(360.0),
            ..before
        }
    );
}

/// The rows of a picture.
fn rows(picture: &str) -> Vec<Vec<char>> {
    picture.lines().map(|line| line.chars().collect()).collect()
}

/// The first place of `sign` below the title.
fn place(rows: &[Vec<char>], sign: char) -> (usize, usize) {
    let mut below = rows.iter().enumerate().skip(2);
    let found = below.find_map(|(y, line)| Some((line.iter().position(|c| *c == sign)?, y)));
    found.unwrap()
}

#[test]
fn the_wheel_is_as_large_as_its_pane_allows() {
    // The wheel is wide for its axle: arrows along the axle that were longer for that would take the room.
    let mut stage = Stage::open("cusps", &[], Rect::new(0, 0, 120, 40));
    stage.commands("pause = true\ngo_to = 0");
    let layout = screen::layout(&stage.lab, true, stage.size);
    let mut panes = layout.panes.iter();
    let (_, place) = panes.find(|(pane, _)| *pane == Pane::ThreeD).unwrap();
    let picture = stage.picture();
    let rows = rows(&picture);
    // Above the legend, whose words have the letter too.
    let of_scene = &rows[place.y as usize + 1..place.bottom() as usize - 4];
    let masses: Vec<_> = of_scene
        .iter()
        .flat_map(|row| {
            let row = &row[place.x as usize..place.right() as usize];
            row.iter()
                .enumerate()
                .filter(|(_, sign)| ['O', 'o', '·'].contains(sign))
                .map(|(x, _)| x)
        })
        .collect();
    let width = masses.iter().max().unwrap() - masses.iter().min().unwrap();
    assert!(width >= 11, "{width} columns in\n{picture}");
}

/// Whether a post leads down from the pivot.
fn has_stand(picture: &str) -> bool {
    let rows = rows(picture);
    let (x, y) = place(&rows, '+');
    (1..=3).all(|down| ('\u{2801}'..='\u{28ff}').contains(&rows[y + down][x]))
}

#[test]
fn the_axle_is_a_heavy_line_from_the_stand_to_its_top() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.commands("pause = true\ngo_to = 600");
    stage.press("d").wait(0.3);
    let picture = stage.picture();
    assert!(has_stand(&picture), "{picture}");
    let rows = rows(&picture);
    let (pivot, top) = (place(&rows, '+'), place(&rows, '*'));
    let between = |from: usize, to: usize, share: f64| {
        (from as f64 + share * (to as f64 - from as f64)).round() as usize
    };
    for share in [0.7, 0.8, 0.9] {
        let (x, y) = (
            between(pivot.0, top.0, share),
            between(pivot.1, top.1, share),
        );
        let across: u32 = (x - 2..=x + 2)
            .map(|x| u32::from(rows[y][x]).saturating_sub(0x2800).count_ones())
            .sum();
        assert!(across >= 10, "{across} dots at {share}:\n{picture}");
    }
}

#[test]
fn a_body_without_weight_stands_on_nothing() {
    for (name, set) in [
        ("torque-free", &[][..]),
        ("method-2", &["motion.gravity_m_per_s2=0"][..]),
    ] {
        let mut stage = Stage::open(name, set, LARGE);
        stage.commands("pause = true");
        stage.press("d").wait(0.3).shows("no weight");
        assert!(!has_stand(&stage.picture()), "{}", stage.picture());
    }
}

#[test]
fn the_legend_names_every_sign_beside_the_exact_motion_too() {
    let mut stage = Stage::open("method-2", &[], Rect::new(0, 0, 120, 40));
    stage.press("t").wait(0.5);
    for words in ["L angular momentum", "+ pivot", "* top", "dots: exact"] {
        stage.shows(words);
    }
}
