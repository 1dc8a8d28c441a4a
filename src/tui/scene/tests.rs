use super::*;
use crate::lab::view::theme::{Background, Theme};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;

const INK: Ink = Ink::Strong(Role::Text);

/// What `draw` draws, seen along y from in front: whether a dot is set, and the dot in the middle.
fn drawn(draw: impl Fn(&mut Scene)) -> (impl Fn(usize, usize) -> bool, (usize, usize)) {
    let area = Rect::new(0, 0, 20, 10);
    let mut dots = Dots::new(area, Marker::Braille);
    let camera = Camera {
        yaw_deg: 0.0,
        pitch_deg: 0.0,
    };
    let shown = Shown {
        middle: (0.0, 0.0),
        half: (1.0, 1.0),
        reach: 1.0,
    };
    let mut scene = Scene::new(area, Marker::Braille, camera, &shown);
    draw(&mut scene);
    let (x, y) = scene.dot(&Vector3::zeros());
    scene.draw(&mut dots);
    let theme = Theme {
        colour: false,
        background: Background::Dark,
    };
    let mut buf = Buffer::empty(area);
    dots.render(&theme, &mut buf);
    let is_set = move |x: usize, y: usize| {
        let sign = buf[((x / 2) as u16, (y / 4) as u16)].symbol();
        let bits = sign
            .chars()
            .next()
            .map_or(0, u32::from)
            .saturating_sub(0x2800);
        bits as u8 & Marker::Braille.bit(x % 2, y % 4) != 0
    };
    (is_set, (x as usize, y as usize))
}

/// Upright and in front.
fn upright(scene: &mut Scene) {
    let [from, to] = [-0.9, 0.9].map(|z| Vector3::new(0.0, -0.5, z));
    scene.line(&from, &to, Stroke::Thin, INK);
}

/// The ends of what is level and behind.
fn level() -> [Vector3<f64>; 2] {
    [-0.9, 0.9].map(|x| Vector3::new(x, 0.5, 0.0))
}

#[test]
fn what_is_nearer_hides_what_is_farther() {
    let (is_set, (x, y)) = drawn(|scene| {
        upright(scene);
        let [from, to] = level();
        scene.line(&from, &to, Stroke::Thin, INK);
    });
    assert!((5..35).all(|row| is_set(x, row)), "the near line is whole");
    assert!(!is_set(x - 1, y) && !is_set(x + 1, y), "a gap beside it");
    assert!(is_set(x - 3, y) && is_set(x + 3, y), "the far line goes on");
}

#[test]
fn nothing_hides_an_arrow_in_front() {
    let (is_set, (x, y)) = drawn(|scene| {
        upright(scene);
        let [from, to] = level();
        scene.arrow(&from, &to, INK, Over::Everything);
    });
    assert!((x - 5..x + 5).all(|x| is_set(x, y)), "the arrow is whole");
    let beside = [is_set(x, y - 1), is_set(x, y + 1)];
    assert_eq!(beside, [false, false], "a gap in the line before it");
    assert!(is_set(x, y - 3) && is_set(x, y + 3), "the line goes on");
}
