//! The page of a figure: its labels, its size and letters, marks of time, and the motion within long time steps.

use super::figures::{
    check_overlaps, drawn, extent_of_lines, least, lines, most, panels, recorded, refusal, run,
    says, spec, with_exact, words,
};
use crate::support::scenarios::parse;
use crate::support::words::has;
use gyrolab::plot::chart::EXACT_COLOR;
use gyrolab::plot::{PageFormat, PageScene, Paint, Point, write};
use gyrolab::report::figure::kind::FigureKind;
use gyrolab::report::figure::labels::FigureLabels;
use gyrolab::report::figure::of_runs::FigureRun;
use gyrolab::report::figure::{FigureSpec, PageStyle};
use std::sync::Arc;

#[test]
fn labels_have_italics_and_scripts_and_panels_their_own_ranges() {
    let runs = [run("cusps", &["motion.steps=300"])];
    let labels = FigureLabels {
        title: Some("*θ*_0_ of run_1".to_owned()),
        y: vec!["*θ* (°)".to_owned()],
        y_ranges: [("tilt_deg".to_owned(), (20.0, 40.0))].into(),
        ..FigureLabels::default()
    };
    let asked = FigureSpec {
        labels,
        decimal_comma: true,
        ..spec("tilt_deg,z_m")
    };
    let scene = drawn(&runs, &asked).scene;
    says(&scene, &["θ₀ of run_1", "θ (°)", "20", "40", "0,05"]);
    assert_eq!(scene.title, "θ₀ of run_1");
    assert!(!words(&scene).iter().any(|word| word.contains('.')));
}

#[test]
fn pages_have_the_requested_height_and_font() {
    const MM: f64 = 72.0 / 25.4;
    let runs = [run("cusps", &["motion.steps=300"])];
    let sizes = |scene: &PageScene| {
        let letters = scene.items.iter().filter_map(|item| item.words.as_ref());
        most(letters.flat_map(|words| words.letters.iter().map(|letter| letter.size_pt)))
    };
    for kind in ["traces", "z_m", "above", "3d"] {
        for (asked, width_mm, height_mm, font_pt) in [
            (spec(kind), 86.0, None, 8.0),
            (
                FigureSpec {
                    height_pt: Some(70.0 * MM),
                    ..spec(kind)
                },
                86.0,
                Some(70.0),
                8.0,
            ),
            (
                FigureSpec {
                    font_pt: Some(10.0),
                    ..with_exact(kind)
                },
                86.0,
                None,
                10.0,
            ),
            (
                FigureSpec {
                    style: PageStyle::Slide,
                    ..with_exact(kind)
                },
                254.0,
                Some(142.9),
                18.0,
            ),
        ] {
            let scene = drawn(&runs, &asked).scene;
            check_overlaps(&scene).unwrap_or_else(|why| panic!("{kind} {font_pt}: {why}"));
            assert!((scene.width_pt / MM - width_mm).abs() < 1e-6, "{kind}");
            if let Some(height_mm) = height_mm {
                assert!((scene.height_pt / MM - height_mm).abs() < 1e-6, "{kind}");
            }
            assert!((sizes(&scene) - font_pt).abs() < 1e-6, "{kind}");
        }
    }
    let low = FigureSpec {
        height_pt: Some(30.0 * MM),
        ..spec("traces")
    };
    has(refusal(&runs, &low), "--height leaves no room");
}

#[test]
fn text_is_aligned_where_fonts_differ() {
    let scene = drawn(&[run("cusps", &["motion.steps=300"])], &spec("z_m")).scene;
    let svg = String::from_utf8(write(&scene, PageFormat::SvgText, None).unwrap()).unwrap();
    let ticks = svg
        .lines()
        .filter(|line| line.contains("text-anchor=\"end\""));
    assert!(ticks.count() >= 3, "{svg}");
    let title = svg
        .lines()
        .find(|line| line.contains(">t</tspan>"))
        .unwrap();
    assert!(title.contains("text-anchor=\"middle\""), "{title}");
}

/// An exact motion that cannot be predicted is no error of the run.
#[test]
fn time_that_cannot_be_predicted_is_marked() {
    let chaotic = parse(include_str!("motions/chaotic-top.toml"));
    let run = FigureRun {
        scenario: Arc::new(chaotic),
        named: "chaotic".to_owned(),
    };
    let scene = drawn(std::slice::from_ref(&run), &spec("traces")).scene;
    let marked = words(&scene);
    let count = marked.iter().filter(|word| **word == "not predictable");
    assert_eq!(count.count(), 1, "{marked:?}");
    let early = FigureSpec {
        to_s: Some(1.0),
        ..spec("traces")
    };
    assert!(!words(&drawn(&[run], &early).scene).contains(&"not predictable"));
}

#[test]
fn figures_name_the_time_step_that_edits_set() {
    let edits = |edits: &str| {
        let text = run("cusps", &["motion.steps=300"]).scenario.to_toml() + edits;
        FigureRun {
            scenario: Arc::new(parse(&text)),
            named: "cusps".to_owned(),
        }
    };
    let at_start = "\n[[edit]]\nstep = 0\nset = { \"motion.time_step_s\" = 0.002 }\n";
    let later = "\n[[edit]]\nstep = 5\nset = { \"motion.time_step_s\" = 0.002 }\n";
    for (text, name) in [
        (at_start, "rk4, Δt = 2 ms"),
        (later, "rk4, Δt = 1 ms, then 2 ms"),
    ] {
        says(&drawn(&[edits(text)], &with_exact("z_m")).scene, &[name]);
    }
}

/// The report's scheme turns the body about Ω: within a step, the top goes along a circle.
#[test]
fn a_step_of_the_report_scheme_is_drawn_as_an_arc() {
    let set = ["motion.steps=100", "motion.gravity_m_per_s2=0"];
    let runs = [run("method-1", &set)];
    let scene = drawn(&runs, &spec("above")).scene;
    let [panel] = panels(&scene)[..] else {
        panic!("one panel")
    };
    let curves = lines(&scene, panel);
    assert!(curves.len() <= 2, "an unbroken line");
    // Without torque it is one circle about L, from above an ellipse through the origin.
    let points: Vec<Point> = curves.iter().flat_map(|item| item.path.points()).collect();
    let [left, top, right, bottom] = extent_of_lines(&scene, panel);
    let middle = Point {
        x: 0.5 * (left + right),
        y: 0.5 * (top + bottom),
    };
    let off = points.iter().map(|at| {
        let x = (at.x - middle.x) / (0.5 * (right - left));
        let y = (at.y - middle.y) / (0.5 * (bottom - top));
        (libm::hypot(x, y) - 1.0).abs()
    });
    let most = most(off);
    assert!(most < 2e-3, "{most} of its radius off");
}

#[test]
fn a_curve_with_ten_steps_per_swing_reaches_its_extremes() {
    // Upright again and again: the exact motion and the report's scheme agree in that.
    for preset in ["method-1", "method-1-steeper"] {
        let run = run(preset, &["motion.steps=300"]);
        let column = FigureKind::named("tilt_deg").unwrap().columns()[0];
        let points = recorded(&run).points(column);
        // The minimum of each swing, which has 11 steps or fewer. The last swing is not complete.
        let swings = points.chunk_by(|a, b| (a[0] / 0.011).floor() == (b[0] / 0.011).floor());
        let lows: Vec<f64> = swings
            .map(|swing| least(swing.iter().map(|at| at[1])))
            .collect();
        assert!(lows.len() > 20);
        let highest = most(lows[..lows.len() - 1].iter().copied());
        assert!(highest < 0.4, "{preset}: {highest} degrees");
    }
}

/// The nutation of the exact motion is smaller than a dot, so the length of the dashes must not include it.
#[test]
fn dashes_of_the_exact_motion_ignore_its_invisible_nutation() {
    let figure = drawn(&[run("wobble-push", &[])], &with_exact("z_m"));
    let [panel] = panels(&figure.scene)[..] else {
        panic!("one panel")
    };
    let exact = lines(&figure.scene, panel).into_iter().filter(
        |item| matches!(&item.paint, Paint::Stroke(pen) if !pen.dash_pt.is_empty() && pen.color == EXACT_COLOR),
    );
    let length_pt: f64 = exact
        .map(|item| {
            let points: Vec<Point> = item.path.points().collect();
            gyrolab::plot::line::length(&points)
        })
        .sum();
    let width_pt = panel[1].x - panel[0].x;
    assert!(
        (length_pt / width_pt - 1.0).abs() < 0.05,
        "{length_pt} {width_pt}"
    );
}
