//! Bodies of solid parts: inertia compared with Steiner's theorem, symmetry, error messages, listing and editing.

use crate::support::scenarios::changed;
use crate::support::scenarios::{parse, read};
use crate::support::stage::{SMALL, Stage};
use crate::support::words::has;
use gyrolab::engine::journal::parameters::{Parameter, parameters, table_of};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::file::ScenarioFile;
use gyrolab::engine::scenario::{Document, Scenario};
use gyrolab::physics::SymmetricTop;
use gyrolab::physics::exact::{ExactMethod, ExactMotion};
use nalgebra::{Matrix3, Rotation3, Vector3};
use proptest::prelude::*;
use std::sync::Arc;
use toml::Value;

/// A scenario of `parts`; `top` is a massless point on the axle.
fn text(parts: &str) -> String {
    format!(
        "title = 'x'\n[[body.point]]\nname = 'top'\nat_m = [0, 0, 1.5]\n{parts}\n[start]\nspin_rpm = 300\n[motion]\ntime_step_s = 0.01\nsteps = 100\n"
    )
}

fn part(shape: &str, dimensions: &str) -> String {
    format!(
        "[[body.part]]\nshape = '{shape}'\nname = '{shape}'\nmass_kg = 2\nat_m = [0, 0, 0.5]\n{dimensions}\n"
    )
}

/// Returns the error message for `parts`, without the file's name.
fn refusal(parts: &str) -> String {
    read(&text(parts)).unwrap_err().to_string()
}

/// A shape, its dimensions from three lengths, and its textbook moments for a mass of 1 kg: across, across, about the axis.
type Solid = (&'static str, String, [f64; 3]);

fn solids([a, b, h]: [f64; 3]) -> Vec<Solid> {
    let ring = a * a;
    let round = |along: f64, across: f64| [across, across, along];
    let [inner, outer] = [a.min(b), a.max(b)];
    let both = inner.powi(2) + outer.powi(2);
    let radius = format!("radius_m = {a:?}");
    let long = format!("{radius}\nlength_m = {h:?}");
    vec![
        ("ring", radius.clone(), round(ring, ring / 2.0)),
        ("cylinder", radius.clone(), round(ring / 2.0, ring / 4.0)),
        (
            "cylinder",
            long.clone(),
            round(ring / 2.0, (3.0 * ring + h * h) / 12.0),
        ),
        (
            "tube",
            format!("inner_radius_m = {inner:?}\nouter_radius_m = {outer:?}\nlength_m = {h:?}"),
            round(both / 2.0, (3.0 * both + h * h) / 12.0),
        ),
        ("rod", format!("length_m = {h:?}"), round(0.0, h * h / 12.0)),
        ("ball", radius.clone(), [0.4 * ring; 3]),
        ("shell", radius, [2.0 * ring / 3.0; 3]),
        (
            "cone",
            long,
            round(0.3 * ring, 3.0 * (4.0 * ring + h * h) / 80.0),
        ),
        (
            "block",
            format!("size_m = [{a:?}, {b:?}, {h:?}]"),
            [
                (b * b + h * h) / 12.0,
                (a * a + h * h) / 12.0,
                (a * a + b * b) / 12.0,
            ],
        ),
    ]
}

fn any_length() -> impl Strategy<Value = f64> {
    0.01..2.0_f64
}

fn any_vector() -> impl Strategy<Value = [f64; 3]> {
    [-2.0..2.0_f64, -2.0..2.0, -2.0..2.0]
}

/// Computes the inertia of a part about the pivot by Steiner's theorem, kg m².
fn steiner(mass: f64, moments: [f64; 3], at: [f64; 3], axis: [f64; 3]) -> Matrix3<f64> {
    let (at, axis) = (Vector3::from(at), Vector3::from(axis));
    let turn = Rotation3::rotation_between(&Vector3::z(), &axis).unwrap();
    let own = Matrix3::from_diagonal(&(mass * Vector3::from(moments)));
    let offset = Matrix3::identity() * at.norm_squared() - at * at.transpose();
    turn.matrix() * own * turn.matrix().transpose() + mass * offset
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn the_inertia_of_parts_follows_steiners_theorem(
        parts in prop::collection::vec(
            (0..9_usize, [any_length(), any_length(), any_length()], any_vector(), any_vector(), 0.01..50.0_f64),
            1..6,
        )
    ) {
        let mut body = String::new();
        let (mut inertia, mut mass_sum, mut first) = (Matrix3::zeros(), 0.0, Vector3::zeros());
        let mut size = 0.0;
        for (index, (which, lengths, at, axis, mass)) in parts.into_iter().enumerate() {
            prop_assume!(Vector3::from(axis).norm() > 0.1);
            let (shape, dimensions, moments) = solids(lengths).swap_remove(which);
            body += &format!(
                "[[body.part]]\nshape = '{shape}'\nname = 'p{index}'\nmass_kg = {mass:?}\nat_m = {at:?}\naxis = {axis:?}\n{dimensions}\n"
            );
            inertia += steiner(mass, moments, at, axis);
            size += mass * (Vector3::from(at).norm_squared() + Vector3::from(moments).amax());
            mass_sum += mass;
            first += mass * Vector3::from(at);
        }
        let Ok(scenario) = read(&text(&body)) else {
            // A single rod that points to the pivot has no inertia about its axis.
            prop_assume!(false);
            return Ok(());
        };
        let mechanics = &scenario.body.mechanics;
        let off = (mechanics.inertia() - inertia).amax() / size;
        prop_assert!(off < 1e-14, "{off:e}");
        prop_assert!((mechanics.mass() - mass_sum).abs() < 1e-14 * mass_sum);
        prop_assert!((mechanics.first_moment() - first).amax() < 1e-14 * size.max(first.amax()));
    }

    #[test]
    fn a_symmetric_part_along_the_axle_keeps_the_body_symmetric(
        which in 0..8_usize, lengths in [any_length(), any_length(), any_length()], height in -2.0..2.0_f64, down: bool
    ) {
        let (shape, dimensions, _) = solids(lengths).swap_remove(which);
        let axis = if down { "axis = [0, 0, -3]" } else { "" };
        let body = format!(
            "[body.rim]\npoints = 4\nradius_m = 0.1\nheight_m = 0\npoint_mass_kg = 0.1\n[[body.part]]\nshape = '{shape}'\nname = 'part'\nmass_kg = 2\nat_m = [0, 0, {height:?}]\n{axis}\n{dimensions}\n"
        );
        let scenario = parse(&text(&body));
        let mechanics = &scenario.body.mechanics;
        let inertia = mechanics.inertia();
        let uneven = [inertia[(0, 0)] - inertia[(1, 1)], inertia[(0, 1)], inertia[(0, 2)], inertia[(1, 2)]];
        for one in uneven {
            prop_assert!(one.abs() <= 1e-12 * inertia.amax(), "{inertia}");
        }
        prop_assert!(SymmetricTop::from_body(mechanics).is_some());
        let loads = Simulation::new(Arc::new(scenario.clone())).loads().clone();
        let exact = ExactMotion::new(mechanics, &loads, &scenario.start);
        prop_assert_eq!(exact.kind(), ExactMethod::Closed);
    }
}

#[test]
fn a_part_is_represented_by_six_points() {
    let scenario = parse(&text(&part("ball", "radius_m = 1")));
    let points = scenario.body.mechanics.points();
    assert_eq!(scenario.body.points_before_parts(), 1);
    // After the point come the massless center and the six points.
    assert_eq!(points.len(), 8);
    assert_eq!((points[1].mass, points[1].at.z), (0.0, 0.5));
    assert!(points[2..].iter().all(|point| point.mass == 2.0 / 6.0));
    // The six points of a ball are at sqrt(3/5) of its radius.
    for point in &points[2..] {
        let far = (point.at - points[1].at).norm();
        assert!((far - 0.6_f64.sqrt()).abs() < 1e-15);
    }
}

#[test]
fn points_precede_parts_and_keep_their_indices() {
    let rim = "[body.rim]\npoints = 3\nradius_m = 1\nheight_m = 0\npoint_mass_kg = 1\n";
    let without = parse(&text(rim));
    let with = parse(&text(&format!("{rim}{}", part("ring", "radius_m = 0.2"))));
    let before = without.body.mechanics.points();
    assert!(with.body.mechanics.points().starts_with(before));
    assert_eq!(with.body.names(), ["top", "ring"]);
}

#[test]
fn the_center_of_a_part_can_be_pushed_and_traced_by_name() {
    let traced = text(&part("ball", "radius_m = 1"))
        .replace("title = 'x'", "title = 'x'\ntrace = 'ball'")
        + "[[push]]\npoint = 'ball'\nforce_N = [1, 0, 0]\nfor_s = 1\n";
    let scenario = parse(&traced);
    assert_eq!(scenario.arm_m(), 0.5);
    assert_eq!(scenario.pushes.first().unwrap().point, scenario.trace);
    let other = traced.replace("point = 'ball'", "point = 'bal'");
    let words = "push.0.point (\"bal\") is not a point of this body: did you mean ball?";
    has(read(&other).unwrap_err().to_string(), words);
}

#[test]
fn errors_in_parts_name_line_key_value_and_rule() {
    let mut parts = Vec::new();
    for (shape, dimensions) in [
        ("ring", ""),
        ("tube", "outer_radius_m = 1\nlength_m = 1"),
        ("ball", "radius_m = 1\nlength_m = 2"),
        ("ring", "radius_m = 1\nmoments_kg_m2 = [1, 1, 1]"),
        ("cylinder", "radius_m = 0"),
        ("cylinder", "radius_m = nan"),
        ("cylinder", "radius_m = 1\nlength_m = -1"),
        ("rod", "length_m = 0"),
        (
            "tube",
            "inner_radius_m = 2\nouter_radius_m = 1\nlength_m = 1",
        ),
        ("block", "size_m = [1, -1, 1]"),
        ("block", "size_m = [1, 1]"),
        ("moments", "moments_kg_m2 = [1, 1, 2.1]"),
        ("ring", "radius_m = 1\naxis = [0, 0, 0]"),
        ("sphere", "radius_m = 1"),
        ("ring", "radius_m = 1\nheight = 1"),
        ("rod", "length_m = 1"),
        ("ring", "radius_m = 1e200"),
    ] {
        parts.push(part(shape, dimensions));
    }
    let ring = part("ring", "radius_m = 1");
    for (from, to) in [
        ("mass_kg = 2", "mass_kg = 0"),
        ("mass_kg = 2\n", ""),
        ("name = 'ring'", "name = 'top'"),
        ("[[body.part]]", "[body.part]"),
    ] {
        parts.push(ring.replace(from, to));
    }
    parts.push(ring.repeat(2));
    let told = parts
        .iter()
        .map(|parts| format!("{parts}{}\n\n", refusal(parts)));
    insta::assert_snapshot!("refusals", told.collect::<String>());
}

#[test]
fn flat_moments_are_accepted_up_to_rounding() {
    let flat = part("moments", "moments_kg_m2 = [0.1, 0.2, 0.30000000000000004]");
    assert!(read(&text(&flat)).is_ok());
    let beyond = part("moments", "moments_kg_m2 = [0.1, 0.2, 0.300000000001]");
    assert!(refusal(&beyond).contains("A + B is below C"));
}

/// A part of 2 kg with moments about the pivot.
fn about_pivot(at: [f64; 3], axis: [f64; 3], moments: [f64; 3]) -> String {
    format!(
        "[[body.part]]\nshape = 'moments'\nname = 'body'\nmass_kg = 2\nat_m = {at:?}\naxis = {axis:?}\n\
         moments_kg_m2 = {moments:?}\nabout = 'pivot'\n"
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn moments_about_the_pivot_follow_the_parallel_axis_theorem(
        lengths in [any_length(), any_length(), any_length()], at in any_vector(), axis in any_vector()
    ) {
        prop_assume!(Vector3::from(axis).norm() > 0.1);
        let (.., block) = solids(lengths).pop().unwrap();
        let whole = steiner(2.0, block, at, axis);
        let turn = Rotation3::rotation_between(&Vector3::z(), &Vector3::from(axis)).unwrap();
        let own = turn.matrix().transpose() * whole * turn.matrix();
        let moments = [own[(0, 0)], own[(1, 1)], own[(2, 2)]];
        let scenario = parse(&text(&about_pivot(at, axis, moments)));
        let off = (scenario.body.mechanics.inertia() - whole).amax() / whole.amax();
        prop_assert!(off < 1e-12, "{off:e}");
    }
}

#[test]
fn moments_about_the_pivot_survive_a_round_trip() {
    let given = text(&about_pivot(
        [0.0, 0.0, 0.2],
        [0.0, 0.0, 1.0],
        [0.4, 0.4, 0.6],
    ));
    let scenario = parse(&given);
    let top = SymmetricTop::from_body(&scenario.body.mechanics).unwrap();
    assert!((top.across - 0.4).abs() < 1e-15 && (top.along - 0.6).abs() < 1e-15);
    assert!((top.first_moment - 0.4).abs() < 1e-15);
    let again = parse(&scenario.to_toml());
    assert_eq!(again.file.body.part, scenario.file.body.part);
    let file = &scenario.file;
    let nearer = changed(file, "body.part.0.at_m.2", Value::Float(0.1)).unwrap();
    assert!((nearer.body.mechanics.inertia()[(0, 0)] - 0.4).abs() < 1e-15);
    let centered = changed(file, "body.part.0.about", Value::from("center")).unwrap();
    assert!((centered.body.mechanics.inertia()[(0, 0)] - 0.48).abs() < 1e-15);
    let block = changed(file, "body.part.0.shape", Value::from("block")).unwrap();
    assert_eq!(block.file.body.part[0].about, None);
    assert!((block.body.mechanics.inertia()[(0, 0)] - 0.4).abs() < 1e-15);
    let rows = listed(&scenario);
    let row = rows.iter().find(|row| row.key == "body.part.0.about");
    assert_eq!(row.map(Parameter::shown).as_deref(), Some("pivot"));
    assert!(
        !listed(&three_parts())
            .iter()
            .any(|one| one.key.contains("part.0.about"))
    );
    // A flat body, and one with all its mass at the pivot up to rounding.
    let flat = about_pivot([0.0, 0.0, 30.0], [0.0, 0.0, 1.0], [1800.1, 1800.1, 0.2]);
    assert!(read(&text(&flat)).is_ok());
}

#[test]
fn impossible_moments_about_the_pivot_are_rejected_with_the_bound() {
    let curtis = about_pivot([0.0, 0.0, 0.05], [0.0, 0.0, 1.0], [12e-4, 12e-4, 4.5e-4])
        .replace("mass_kg = 2", "mass_kg = 0.5");
    let told = refusal(&curtis);
    has(
        &told,
        "about the pivot A must be at least M d^2 = 1.25e-3 kg m^2",
    );
    // The suggested body has the same motion.
    has(&told, "mass_kg = 1 with at_m = [0, 0, 0.025]");
    let alike = curtis
        .replace("mass_kg = 0.5", "mass_kg = 1")
        .replace("0.05]", "0.025]");
    let body = parse(&text(&alike)).body;
    assert!((body.mechanics.inertia()[(0, 0)] - 12e-4).abs() < 1e-18);
    let flat = about_pivot([0.0, 0.0, 0.2], [0.0, 0.0, 1.0], [0.4, 0.4, 0.7]);
    has(
        refusal(&flat),
        "about the pivot A + B - C must be at least 2 M d^2 = 1.6e-1",
    );
    let aside = about_pivot([0.3, 0.0, 0.2], [0.0, 0.0, 1.0], [0.4, 0.45, 0.1]);
    has(
        refusal(&aside),
        "about the pivot C must be at least M d^2 = 1.8e-1",
    );
    let unreal = about_pivot([0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 2.1]);
    has(refusal(&unreal), "A + B is below C");
    for wrong in [
        part("ring", "radius_m = 1\nabout = 'pivot'"),
        part("moments", "moments_kg_m2 = [1, 1, 1]\nabout = 'middle'"),
        about_pivot([0.0, 0.0, 1e200], [0.0, 0.0, 1.0], [1.0; 3]),
    ] {
        assert!(!refusal(&wrong).contains("NaN"), "{wrong}");
    }
}

#[test]
fn a_part_counts_as_six_points() {
    let many = |rim: usize| {
        let rim =
            format!("[body.rim]\npoints = {rim}\nradius_m = 1\nheight_m = 0\npoint_mass_kg = 1\n");
        text(&(rim + &part("ring", "radius_m = 1")))
    };
    assert!(read(&many(99_993)).is_ok());
    let words = "body: has 100001 points, six for each part; at most 100000 are allowed";
    has(read(&many(99_994)).unwrap_err().to_string(), words);
}

/// A scenario with a disk on a rod and a block on the axle.
fn three_parts() -> Scenario {
    parse(&text(
        &(part("cylinder", "radius_m = 0.3")
            + &part("rod", "length_m = 1")
            + &part("block", "size_m = [0.1, 0.1, 0.2]")),
    ))
}

fn listed(scenario: &Scenario) -> Vec<Parameter> {
    parameters(&table_of(&scenario.file), scenario)
}

#[test]
fn parts_list_exactly_the_dimensions_of_their_shape() {
    let list = listed(&three_parts());
    for (shape, dimensions) in [
        ("cylinder", "radius 0.3, length 0"),
        ("rod", "length 1"),
        ("block", "size x 0.1, size y 0.1, size z 0.2"),
    ] {
        let group = format!("part {shape}");
        let rows: Vec<_> = list
            .iter()
            .filter(|row| row.group == group)
            .map(|row| format!("{} {}", row.label, row.shown()))
            .collect();
        let place = "mass 2, x 0, y 0, z 0.5, axis x 0, axis y 0, axis z 1";
        let all = format!("shape {shape}, name {shape}, {place}, {dimensions}");
        assert_eq!(rows.join(", "), all);
    }
    let traced = list.iter().find(|row| row.key == "trace").unwrap();
    assert_eq!(traced.choices, ["top", "cylinder", "rod", "block"]);
}

fn refused(file: &ScenarioFile, key: &str, value: impl Into<Value>) -> String {
    changed(file, key, value.into()).unwrap_err().in_one_line()
}

#[test]
fn every_value_of_a_part_can_be_changed_or_explains_why_not() {
    let scenario = three_parts();
    let file = &scenario.file;
    let wider = changed(file, "body.part.0.radius_m", Value::Float(0.6)).unwrap();
    // The disk contributes m R²/2 to I3, the block m (a² + b²)/12.
    let along = wider.body.mechanics.inertia()[(2, 2)];
    let known = 0.36 + 2.0 * 0.02 / 12.0;
    assert!((along - known).abs() < 1e-15, "{along}");
    let higher = changed(file, "body.part.2.at_m.2", Value::Float(2.0)).unwrap();
    assert_eq!(higher.file.body.part[2].at_m, [0.0, 0.0, 2.0]);
    let thicker = changed(file, "body.part.0.length_m", Value::Float(0.1)).unwrap();
    assert_eq!(thicker.file.body.part[0].length_m, Some(0.1));
    let leaning = changed(file, "body.part.0.axis.0", Value::Float(1.0)).unwrap();
    assert_eq!(leaning.file.body.part[0].axis, Some([1.0, 0.0, 1.0]));
    assert_eq!(
        refused(file, "body.part.0.radius_m", -1.0),
        "body.part.0.radius_m (-1.0) must be greater than zero"
    );
    assert!(refused(file, "body.part.1.name", "top").contains("is also the name of a point"));
}

#[test]
fn changing_the_shape_of_a_part_keeps_its_size() {
    let shapes: Vec<_> = solids([0.3, 0.4, 0.5]);
    for (shape, dimensions, _) in &shapes {
        let scenario = parse(&text(
            &(part(shape, dimensions)
                + &part("ring", "radius_m = 1").replace("'ring'\nmass", "'r'\nmass")),
        ));
        for (other, ..) in &shapes {
            let turned = changed(&scenario.file, "body.part.0.shape", Value::from(*other))
                .unwrap_or_else(|problems| panic!("{shape} to {other}: {problems}"));
            assert_eq!(turned.file.body.part[0].shape, *other);
        }
        // Converted to moments, it is the same body.
        let moments = changed(&scenario.file, "body.part.0.shape", Value::from("moments")).unwrap();
        let off = moments.body.mechanics.inertia() - scenario.body.mechanics.inertia();
        assert!(off.amax() < 1e-14, "{shape}: {off}");
        assert!(moments.file.body.part[0].moments_kg_m2.is_some());
    }
    let told = refused(&three_parts().file, "body.part.0.shape", "egg");
    assert!(told.contains("must be one of ring, cylinder"), "{told}");
}

#[test]
fn dotted_keys_set_a_part_from_the_command_line() {
    let mut document = Document::parse("x.toml", &text(&part("ring", "radius_m = 1"))).unwrap();
    document.set("body.part.0.radius_m=0.5").unwrap();
    document
        .set("body.part.1={shape='ball',name='bob',mass_kg=1,at_m=[0,0,1],radius_m=0.1}")
        .unwrap();
    let scenario = document.scenario().unwrap();
    assert_eq!(scenario.body.parts.len(), 2);
    assert!((scenario.body.mechanics.inertia()[(2, 2)] - (0.5 + 0.004)).abs() < 1e-15);
    document.set("body.part.1.axis.0=1").unwrap();
    document.set("body.part.1.shape=cone").unwrap();
    let changed = document.scenario().unwrap().file;
    assert_eq!(changed.body.part[1].axis, Some([1.0, 0.0, 1.0]));
    assert_eq!(changed.body.part[1].length_m, Some(0.2));
    document.set("body.part.0.radius_m=0").unwrap();
    let words = "--set body.part.0.radius_m=0: body.part.0.radius_m (0) must be greater than zero";
    has(document.scenario().unwrap_err().to_string(), words);
}

#[test]
fn a_run_file_with_parts_survives_a_round_trip() {
    let scenario = three_parts();
    let again = parse(&scenario.to_toml());
    assert_eq!(again.to_toml(), scenario.to_toml());
    assert_eq!(again.body.mechanics, scenario.body.mechanics);
}

#[test]
fn solids_are_recognizable_in_the_3d_view() {
    let filled = |preset: &str, set: &[&str], seconds: f64| {
        let mut stage = Stage::open(preset, set, SMALL);
        stage.wait(seconds).press("d").picture()
    };
    insta::assert_snapshot!("wing_nut_3d", filled("wing-nut", &[], 0.6));
    // A cone on its apex and a rod next to it.
    let cone = [
        "body.part.0={shape='cone',name='cone',mass_kg=1,at_m=[0,0,0.6],radius_m=0.3,length_m=0.8}",
        "body.part.1={shape='rod',name='rod',mass_kg=0.1,at_m=[0.6,0,0.6],axis=[1,0,0],length_m=0.4}",
    ];
    insta::assert_snapshot!("cone_and_rod_3d", filled("sleeping", &cone, 0.6));
}

#[test]
fn a_part_can_be_edited_in_the_values_pane() {
    let mut stage = Stage::open("wing-nut", &[], SMALL);
    stage.commands("pause = true").press("e/outer\n");
    stage.shows("outer radius = 0.008 m").press("0.009\n");
    stage.shows("outer radius 0.009 m, rerun");
    let nut = &stage.lab.player().run().scenario().file.body.part[0];
    assert_eq!(nut.outer_radius_m, Some(0.009));
    // A rejected value explains why and changes nothing.
    stage.press("\n").press("0.001\n");
    stage.shows("must not be greater than outer_radius_m");
    let unchanged = &stage.lab.player().run().scenario().file.body.part[0];
    assert_eq!(unchanged.outer_radius_m, Some(0.009));
}
