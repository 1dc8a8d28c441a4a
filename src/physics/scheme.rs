//! The table of the numerical schemes. What each must do is [`Scheme`]'s. A new one is a row here and a file in `scheme`.

mod runge_kutta;

use super::exact::Exact;
use super::splitting::{SplittingMethod, SplittingScheme};
use super::stepping::Scheme;
use super::{Body, Friction, report::ReportScheme};
use runge_kutta::{RK4, RungeKutta};

/// One row of the table of schemes.
#[derive(Debug)]
pub struct SchemeInfo {
    /// Its name, by which [`find`](Self::find) finds it.
    pub name: &'static str,
    /// Order of convergence in dt; `None` where the time step makes no error.
    pub order: Option<u32>,
    /// One line on what it does.
    pub about: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// Whether it follows time between steps, so that a force which begins in mid-step is met where it begins. One
    /// that does not feels such a force's mean over the step.
    pub continuous: bool,
    /// Whether it turns the body by its free motion exactly, however far that leads in one step. The others must turn it by
    /// little in a step for their rows to show the motion.
    pub turns_exactly: bool,
    /// The friction that it can be true to.
    pub admits: Admits,
    make: fn(&Body) -> Box<dyn Scheme>,
}

/// The friction that a scheme can be true to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Admits {
    /// Any.
    Any,
    /// Any but dry friction.
    WithoutDry,
    /// None.
    None,
}

impl Admits {
    /// Why a scheme of this kind cannot be true to `friction`; `None` where it can.
    pub fn why_not(self, friction: &Friction) -> Option<&'static str> {
        match self {
            Self::None if !friction.is_none() => {
                Some("goes backwards in time within a step, where friction would feed the motion")
            }
            Self::WithoutDry if friction.spin_dry > 0.0 => Some(
                "takes the torque as smooth in time, which dry friction is not where it stops the spin",
            ),
            _ => None,
        }
    }
}

/// Every scheme, the report's first.
pub const SCHEMES: &[SchemeInfo] = &[
    SchemeInfo {
        name: "report",
        order: Some(1),
        about: "the report's: rotate every point by Omega dt, then add dt times the torque at the new positions to L",
        source: "report, section 3",
        continuous: false,
        turns_exactly: false,
        admits: Admits::Any,
        make: |body| Box::new(ReportScheme::new(body)),
    },
    SchemeInfo {
        name: "rk4",
        order: Some(4),
        about: "classical Runge-Kutta on orientation and L, the orientation made orthogonal after each step",
        source: "Kutta 1901; Hairer, Norsett, Wanner, Solving ODEs I, section II.1",
        continuous: true,
        turns_exactly: false,
        admits: Admits::WithoutDry,
        make: |body| Box::new(RungeKutta::new(&RK4, body)),
    },
    SchemeInfo {
        name: "strang",
        order: Some(2),
        about: "symplectic splitting: half a kick by the torque, the free motion exactly, half a kick",
        source: "Strang, SIAM J. Numer. Anal. 5, 506 (1968); for the top: Reich, Fields Inst. Commun. 10, 181 (1996)",
        continuous: true,
        turns_exactly: true,
        admits: Admits::Any,
        make: |body| Box::new(SplittingScheme::new(SplittingMethod::Strang, body)),
    },
    SchemeInfo {
        name: "srkn11b",
        order: Some(6),
        about: "symplectic splitting of kicks and exact free motion in eleven stages, a Runge-Kutta-Nystrom composition",
        source: "Blanes and Moan, J. Comput. Appl. Math. 142, 313 (2002), table 3",
        continuous: true,
        turns_exactly: true,
        admits: Admits::None,
        make: |body| Box::new(SplittingScheme::new(SplittingMethod::Srkn11b, body)),
    },
    SchemeInfo {
        name: "exact",
        order: None,
        about: "the true motion: elliptic functions for a symmetric body pushed on its axle, else an integration held to 1e-12",
        source: "Klein and Sommerfeld, Theorie des Kreisels, chapter VI; Whittaker, Analytical Dynamics, sections 71-72",
        continuous: true,
        turns_exactly: true,
        admits: Admits::Any,
        make: |body| Box::new(Exact::new(body)),
    },
];

/// The schemes that can be true to `friction`, in the table's order.
pub fn true_to(friction: Friction) -> impl Iterator<Item = &'static SchemeInfo> + Clone {
    SCHEMES
        .iter()
        .filter(move |scheme| scheme.admits.why_not(&friction).is_none())
}

/// The names of all schemes, in the table's order.
pub const fn names() -> [&'static str; SCHEMES.len()] {
    let mut names = [""; SCHEMES.len()];
    let mut row = 0;
    while row < SCHEMES.len() {
        names[row] = SCHEMES[row].name;
        row += 1;
    }
    names
}

impl SchemeInfo {
    /// The scheme of that name.
    pub fn find(name: &str) -> Option<&'static Self> {
        SCHEMES.iter().find(|scheme| scheme.name == name)
    }

    /// Returns a scheme for `body`. It must be [loaded](Scheme::load) and [started](Scheme::start) before its first step;
    /// [`SteppedMotion`](super::SteppedMotion) does this, and checks the arguments.
    pub fn make(&self, body: &Body) -> Box<dyn Scheme> {
        (self.make)(body)
    }
}

impl PartialEq for SchemeInfo {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}
