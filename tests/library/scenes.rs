//! The camera of the 3-D view, and its contents after a scheme broke down.

use crate::support::stage::{LARGE, SMALL, Stage};
use gyrolab::lab::view::Pane;
use gyrolab::plot::camera::Camera;
use gyrolab::tui::keymap::Key;
use gyrolab::tui::screen;
use ratatui::layout::Rect;

/// Returns the projected length of the axle, relative to its true length.
fn axle_in_picture(stage: &Stage) -> f64 {
    let axle = stage.lab.player().run().simulation().state().axle();
    let (right, up) = stage.lab.view().camera.project(&axle);
    right.hypot(up)
}

#[test]
fn the_camera_shows_the_axle_at_an_angle_and_does_not_move() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    assert!(axle_in_picture(&stage) > 0.7);
    let opened = stage.lab.view().camera;
    stage.commands("speed = 20");
    for _ in 0..40 {
        stage.press(" ").wait(1.0);
        assert_eq!(
            stage.lab.view().camera,
            opened,
            "the axle would seem to jump"
        );
    }
    for step in [1200, 5, 2300] {
        stage.commands(&format!("go_to = {step}"));
        assert_eq!(stage.lab.view().camera, opened);
    }
    stage.commands("open = 'cusps'");
    assert!(axle_in_picture(&stage) > 0.7);
    // A chosen camera is kept.
    stage.press("d→");
    let chosen = stage.lab.view().camera;
    for step in (0..2300).step_by(100) {
        stage.commands(&format!("go_to = {step}"));
        assert_eq!(stage.lab.view().camera, chosen);
    }
    // The default direction does not count as chosen.
    stage.commands("camera = { yaw_deg = 30, pitch_deg = 20 }\ngo_to = 0");
    assert_ne!(stage.lab.view().camera, chosen);
    assert!(axle_in_picture(&stage) > 0.7);
}

#[test]
fn the_camera_does_not_move_during_playback() {
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
        "the axle points toward the viewer at times: {shortest}"
    );
}

#[test]
fn after_a_breakdown_the_last_valid_state_is_shown() {
    let set = ["motion.scheme=rk4", "motion.time_step_s=0.03"];
    let mut stage = Stage::open("method-2", &set, LARGE);
    stage.wait(2.0).shows("no longer finite at step 31");
    stage.shows("from above (m) at step 29: then the scheme broke down");
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
    // In a narrow pane, the title is shorter, but complete.
    let mut small = Stage::open("method-2", &set, SMALL);
    small.wait(2.0).shows("from above (m), step 29 ");
}

#[test]
fn at_120_columns_the_3d_and_top_views_share_a_column() {
    let stage = Stage::open("method-2", &[], Rect::new(0, 0, 120, 40));
    let layout = screen::layout(&stage.lab, true, stage.size);
    let place = |wanted: Pane| {
        let mut panes = layout.panes.iter();
        panes.find(|(pane, _)| *pane == wanted).unwrap().1
    };
    let (above, space, traces) = (place(Pane::Above), place(Pane::ThreeD), place(Pane::Traces));
    assert_eq!(
        (above.x, above.width, above.bottom() + 1),
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
