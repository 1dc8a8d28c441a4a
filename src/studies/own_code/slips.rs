//! The table of slips: common mistakes, each of which changes one thing in the report's step.

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Sequence {
    /// Inertia, Omega, turn, torque, L.
    #[default]
    Report,
    /// Inertia, Omega, torque, turn, L.
    TorqueBeforeTurn,
    /// Torque, L, inertia, Omega, turn.
    LBeforeTurn,
}

/// A point that replaces another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Other {
    /// The n-th of the axle's other points, counted from 0.
    OfAxle(usize),
    FirstOfRim,
    CenterOfRim,
}

/// Ways in which Omega is made parallel to L.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Along {
    /// The body turns about L by |Omega|.
    AxisAlone,
    /// L is divided by the matrix's third diagonal element.
    OverThird,
    /// L is divided by the matrix's first diagonal element.
    OverFirst,
    /// L is divided by the moment about the axle.
    OverAxle,
    /// L is divided by the mean moment across the axle.
    OverAcross,
}

/// Everything that a slip can change in the report's step. Fields without a comment do what the slip of that name says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mutations {
    pub(super) inertia_kept: bool,
    pub(super) inertia_sums_up: bool,
    /// Products of inertia: 1 adds them, 2 omits them.
    pub(super) products: u8,
    pub(super) without_e: bool,
    /// Omits the projector P from the rotation.
    pub(super) without_projector: bool,
    /// Replaces every component of E in the rotation by this number.
    pub(super) turn_e: Option<f64>,
    /// Reverses the middle component of a cross product: true for r x F, false for Omega x r.
    pub(super) middle_sign: Option<bool>,
    pub(super) about_centre: bool,
    /// Omits a rim point: true for the last instead of the first; true to omit its weight too.
    pub(super) left_out: Option<(bool, bool)>,
    /// Gives the axle's points mass: true for its top alone.
    pub(super) axle_mass: Option<bool>,
    pub(super) rim_point_twice: bool,
    pub(super) rotation_reversed: bool,
    /// Power of dt in the angle of the rotation, instead of 1.
    pub(super) turn_dt: Option<i32>,
    pub(super) axis_not_unit: bool,
    /// Uses |Omega|^2 in the angle: true to divide Omega by it too.
    pub(super) omega_squared: Option<bool>,
    pub(super) along_momentum: Option<Along>,
    pub(super) first_order: bool,
    /// Factor of the angle.
    pub(super) angle: Option<f64>,
    pub(super) sequence: Sequence,
    pub(super) row_late: bool,
    /// Rotates in place: true if the new y is used for z too.
    pub(super) in_place: Option<bool>,
    /// Power of dt in the torque, instead of 1.
    pub(super) torque_dt: Option<i32>,
    /// Weights of g instead of m g: true for the points without mass too.
    pub(super) without_mass: Option<bool>,
    /// Gives each rim point the mass of the whole body: true in the inertia too.
    pub(super) total_on_each: Option<bool>,
    pub(super) traced: Option<Other>,
    pub(super) swapped: Option<(usize, usize)>,
    /// Exchanges x and y, and Lx and Ly too.
    pub(super) swapped_twice: bool,
    pub(super) torque_reversed: bool,
    pub(super) gravity_up: bool,
    /// Measures r from the center of mass in the torque.
    pub(super) about_cm: bool,
    /// Takes the torque at the center of mass: true for all forces, false for one point's weight.
    pub(super) centre: Option<bool>,
    /// Applies the whole weight at the traced point.
    pub(super) weight_at_top: bool,
    /// Puts the hub into the plane of the rim.
    pub(super) hub_in_plane: bool,
    pub(super) sums_up: bool,
    pub(super) gravity: Option<f64>,
    pub(super) kept: bool,
    /// Rotates L with the body: true if the torque is added too.
    pub(super) turned: Option<bool>,
    pub(super) other_frame: bool,
    /// The axis of the tilt: true if only the points are tilted about it.
    pub(super) tilt_axis: Option<([f64; 3], bool)>,
    pub(super) tilt_in_radians: bool,
    /// Number of steps by which the push is delayed.
    pub(super) push_shift: i64,
    /// Number of additional steps of the push.
    pub(super) push_longer: i64,
    pub(super) accumulates: bool,
    pub(super) push_reversed: bool,
    pub(super) push_point: Option<Other>,
    pub(super) time_step_s: Option<f64>,
}

/// A common mistake in programs of the report's step.
///
/// It consists of a name, the program's behavior and the report's behavior (both without a period), and variants. A
/// variant has a note and a change; `{n}` in a note is the name of the n-th of the axle's other points.
type Slip = (
    &'static str,
    &'static str,
    &'static str,
    &'static [(&'static str, fn(&mut Mutations))],
);

const DEGREES: f64 = std::f64::consts::PI / 180.0;
const TURNS: f64 = std::f64::consts::TAU;
pub(super) const FOREVER: i64 = i64::MAX / 4;

/// All slips that are tried, except for another time step, which is read from the file.
#[rustfmt::skip]
pub const SLIPS: &[Slip] = &[
    ("inertia-kept", "the inertia is summed once, at the start", "sums it again in each step, from the rotated points", &[("", |c| c.inertia_kept = true)]),
    ("inertia-sums-up", "the inertia is never reset to zero, and adds up over the steps", "sums it again in each step", &[("", |c| c.inertia_sums_up = true)]),
    ("inertia-product-sign", "the products of inertia are added", "subtracts them: I = sum m (|r|^2 E - r r^T)", &[("", |c| c.products = 1)]),
    ("inertia-diagonal", "the products of inertia are missing, or L is divided by the diagonal alone", "solves I Omega = L with the whole matrix", &[("", |c| c.products = 2)]),
    ("inertia-without-E", "r r^T is subtracted from the number r.r, in each of the nine places", "multiplies r.r by the unit matrix E first", &[("", |c| c.without_e = true)]),
    ("inertia-about-centre", "the inertia is about the center of mass", "measures r from the pivot, like L", &[("", |c| c.about_centre = true)]),
    ("point-left-out", "one point of the rim is missing from the sum", "sums over every point", &[
        ("the first, in the inertia alone", |c| c.left_out = Some((false, false))),
        ("the last, in the inertia alone", |c| c.left_out = Some((true, false))),
        ("the first, in inertia and weight", |c| c.left_out = Some((false, true))),
        ("the last, in inertia and weight", |c| c.left_out = Some((true, true)))]),
    ("top-has-mass", "points of the axle have the mass of a rim point", "gives the axle no mass", &[
        ("all of them", |c| c.axle_mass = Some(false)), ("the top alone", |c| c.axle_mass = Some(true)),
        ("all of them, the hub in the plane of the rim", |c| (c.axle_mass, c.hub_in_plane) = (Some(false), true))]),
    ("rim-point-twice", "the first and the last point of the rim coincide, as linspace(0, 2*pi, n) places them", "puts n points at n different angles, 2 pi/n apart", &[("", |c| c.rim_point_twice = true)]),
    ("rotation-without-E", "the rotation matrix lacks the unit matrix E", "has R = P + cos(angle) (E - P) + sin(angle) [u]x", &[
        ("1 - P in each of the nine places", |c| c.turn_e = Some(1.0)), ("-P in the place of E - P", |c| c.turn_e = Some(0.0))]),
    ("projector-missing", "P is missing from the rotation matrix, which is then not a rotation", "has R = P + cos(angle) (E - P) + sin(angle) [u]x", &[("", |c| c.without_projector = true)]),
    ("cross-product-sign", "the middle component of a cross product has the wrong sign", "uses a3 b1 - a1 b3", &[
        ("of r x F", |c| c.middle_sign = Some(true)), ("of Omega x r, as in the second row of [u]x", |c| c.middle_sign = Some(false))]),
    ("rotation-reversed", "the points are rotated by minus the angle, as with the transposed R", "turns them by +|Omega| dt about Omega", &[("", |c| c.rotation_reversed = true)]),
    ("dt-forgotten", "the points are turned by |Omega|", "turns them by |Omega| dt", &[("", |c| c.turn_dt = Some(0))]),
    ("axis-not-unit", "P and the cross matrix are made from Omega itself", "makes them from the unit vector Omega/|Omega|", &[("", |c| c.axis_not_unit = true)]),
    ("omega-squared", "the points are turned by |Omega|^2 dt", "turns them by |Omega| dt", &[
        ("", |c| c.omega_squared = Some(false)), ("u is Omega divided by |Omega|^2, too", |c| c.omega_squared = Some(true))]),
    ("omega-along-L", "Omega is parallel to L", "solves I Omega = L, and Omega is not parallel to L in general", &[
        ("u is L/|L|, the angle |Omega| dt", |c| c.along_momentum = Some(Along::AxisAlone)), ("L is divided by Izz", |c| c.along_momentum = Some(Along::OverThird)),
        ("L is divided by Ixx", |c| c.along_momentum = Some(Along::OverFirst)),
        ("L is divided by the moment about the axle", |c| c.along_momentum = Some(Along::OverAxle)),
        ("L is divided by the moment across the axle", |c| c.along_momentum = Some(Along::OverAcross))]),
    ("first-order-rotation", "the points move by dt Omega x r", "turns them by the rotation matrix", &[("", |c| c.first_order = true)]),
    ("angle-in-degrees", "degrees and radians are mixed up in the angle of the turn", "turns by |Omega| dt radians", &[
        ("radians in cosd and sind", |c| c.angle = Some(DEGREES)), ("degrees in cos and sin", |c| c.angle = Some(1.0 / DEGREES))]),
    ("angle-in-turns", "the angle of the turn is too large or too small by a factor 2 pi", "turns by |Omega| dt radians", &[
        ("times 2 pi", |c| c.angle = Some(TURNS)), ("divided by 2 pi", |c| c.angle = Some(1.0 / TURNS))]),
    ("torque-before-turn", "the torque is computed before the points are turned", "turns them first, then sums r x F", &[("", |c| c.sequence = Sequence::TorqueBeforeTurn)]),
    ("L-before-turn", "L gets its torque first, and the points are turned with the new L", "turns the points with the old L, and then adds the torque to L", &[("", |c| c.sequence = Sequence::LBeforeTurn)]),
    ("L-a-row-late", "L is written a row late: in each row it is the L before the step", "writes the points and L after the step in one row", &[("", |c| c.row_late = true)]),
    ("points-in-place", "x is turned in place, and the new x is used for y and z", "turns all three from the old x, y and z", &[
        ("and the new y for z", |c| c.in_place = Some(true)), ("", |c| c.in_place = Some(false))]),
    ("dt-missing-in-torque", "the torque is added to L without dt", "adds dt times the torque", &[("", |c| c.torque_dt = Some(0))]),
    ("dt-squared", "dt is multiplied twice", "multiplies by dt once", &[
        ("in the torque", |c| c.torque_dt = Some(2)), ("in the angle of the turn", |c| c.turn_dt = Some(2))]),
    ("force-without-mass", "the weight of a point is g", "uses m g", &[
        ("also of the points without mass", |c| c.without_mass = Some(true)), ("of the points with mass", |c| c.without_mass = Some(false)),
        ("also of the points without mass, the hub in the plane of the rim", |c| (c.without_mass, c.hub_in_plane) = (Some(true), true))]),
    ("total-mass-on-each", "each rim point has the mass of the whole body", "gives each point its own mass", &[
        ("in the weight", |c| c.total_on_each = Some(false)), ("in inertia and weight", |c| c.total_on_each = Some(true))]),
    ("no-gravity", "there is no weight", "pulls each point down by m g", &[("", |c| c.gravity = Some(0.0))]),
    ("hub-traced", "another point is traced", "traces the axle's top", &[
        ("{0}", |c| c.traced = Some(Other::OfAxle(0))), ("{1}", |c| c.traced = Some(Other::OfAxle(1))),
        ("{2}", |c| c.traced = Some(Other::OfAxle(2))), ("the first of the rim", |c| c.traced = Some(Other::FirstOfRim)),
        ("the center of the rim", |c| c.traced = Some(Other::CenterOfRim))]),
    ("columns-swapped", "two columns are exchanged", "has x, y, z in this order", &[
        ("x and y", |c| c.swapped = Some((0, 1))), ("x and z", |c| c.swapped = Some((0, 2))), ("y and z", |c| c.swapped = Some((1, 2))),
        ("Lx and Ly", |c| c.swapped = Some((3, 4))), ("Lx and Lz", |c| c.swapped = Some((3, 5))), ("Ly and Lz", |c| c.swapped = Some((4, 5))),
        ("x and y, Lx and Ly too", |c| c.swapped_twice = true)]),
    ("torque-reversed", "the torque is F x r", "uses r x F", &[("", |c| c.torque_reversed = true)]),
    ("gravity-up", "the weight points up", "has it along -z", &[("", |c| c.gravity_up = true)]),
    ("torque-of-centre", "the forces act at one common point", "sums r x F over the points, each with its own r and F", &[
        ("the center of mass, with the mass of one point", |c| c.centre = Some(false)),
        ("the center of mass, with the whole mass, the push there too", |c| c.centre = Some(true)),
        ("the axle's top, with the whole mass", |c| c.weight_at_top = true)]),
    ("torque-about-cm", "the torque is taken about the center of mass, with r - r_cm, as the report's formula (1) reads", "takes it about the pivot, like L", &[("", |c| c.about_cm = true)]),
    ("torque-sums-up", "the torque is never reset to zero, and adds up over the steps", "sums it again in each step", &[("", |c| c.sums_up = true)]),
    ("gravity-9.81", "g is 9.81", "has g = 9.8", &[("", |c| c.gravity = Some(9.81))]),
    ("gravity-10", "g is 10", "has g = 9.8", &[("", |c| c.gravity = Some(10.0))]),
    ("L-kept", "L is never updated", "adds dt times the torque to L in each step", &[("", |c| c.kept = true)]),
    ("L-turned", "L is turned with the body", "keeps L in the world frame, where only the torque changes it", &[
        ("and the torque is added", |c| c.turned = Some(true)), ("and no torque is added", |c| c.turned = Some(false))]),
    ("L-other-frame", "L starts in the wrong frame: rotated although it is given in the world frame, or not rotated although it is given in the body frame", "uses the frame that the scenario states", &[("", |c| c.other_frame = true)]),
    ("tilt-other-axis", "the body is tilted about another axis", "tilts it about +x", &[
        ("about -x", |c| c.tilt_axis = Some(([-1.0, 0.0, 0.0], false))), ("about +y", |c| c.tilt_axis = Some(([0.0, 1.0, 0.0], false))),
        ("about -y", |c| c.tilt_axis = Some(([0.0, -1.0, 0.0], false))), ("about -x, the points alone", |c| c.tilt_axis = Some(([-1.0, 0.0, 0.0], true))),
        ("about +y, the points alone", |c| c.tilt_axis = Some(([0.0, 1.0, 0.0], true))), ("about -y, the points alone", |c| c.tilt_axis = Some(([0.0, -1.0, 0.0], true)))]),
    ("tilt-in-radians", "the tilt in degrees is used as radians", "converts it", &[("", |c| c.tilt_in_radians = true)]),
    ("push-early", "the push ends one step too early: it starts a step early, or acts one step less", "pushes from its first step to its last", &[
        ("", |c| c.push_longer = -1), ("a step early", |c| c.push_shift = -1)]),
    ("push-late", "t is the time at the start of the step, so that the push acts a step later", "uses t = step times dt", &[("", |c| c.push_shift = 1)]),
    ("push-too-long", "the push acts too long", "ends it after its last step", &[
        ("one step more", |c| c.push_longer = 1), ("to the end of the run", |c| c.push_longer = FOREVER)]),
    ("push-accumulates", "the push is added to an array of forces that is never reset, and grows with each step", "builds F again in each step", &[("", |c| c.accumulates = true)]),
    ("push-reversed", "the push has the opposite sign", "pushes along the force as the scenario states it", &[("", |c| c.push_reversed = true)]),
    ("push-on-another-point", "the push acts on another point", "pushes the point that the scenario names", &[
        ("{0}", |c| c.push_point = Some(Other::OfAxle(0))), ("{1}", |c| c.push_point = Some(Other::OfAxle(1))),
        ("{2}", |c| c.push_point = Some(Other::OfAxle(2))), ("the first of the rim", |c| c.push_point = Some(Other::FirstOfRim)),
        ("the center of the rim", |c| c.push_point = Some(Other::CenterOfRim))]),
];

/// This slip is another interpretation of the report's text, not a mistake.
pub const ANOTHER_READING: &str = "push-late";
