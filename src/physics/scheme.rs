//! The table of the numerical schemes. A new scheme implements [`Scheme`] in a file in `scheme`, and has a row here.

mod runge_kutta;

use super::exact::Exact;
use super::splitting::{SplittingMethod, SplittingScheme};
use super::stepping::Scheme;
use super::{Body, Friction, report::ReportScheme};
use runge_kutta::{RK4, RungeKutta};

/// One row of the table of schemes.
#[derive(Debug)]
pub struct SchemeInfo {
    /// Name, as for [`find`](Self::find).
    pub name: &'static str,
    /// Order of convergence in dt; `None` if the time step makes no error.
    pub order: Option<u32>,
    /// Description in one line.
    pub about: &'static str,
    /// Literature.
    pub source: &'static str,
    /// True if the scheme can begin and end a force within a step. Any other scheme uses the mean of the force over the
    /// step.
    pub continuous: bool,
    /// True if the scheme computes the free rotation of the body exactly, however far the body turns in one step. With any
    /// other scheme, the body must turn little per step.
    pub turns_exactly: bool,
    /// The friction that the scheme supports.
    pub admits: Admits,
    make: fn(&Body) -> Box<dyn Scheme>,
}

/// The friction that a scheme supports.
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
    /// Returns why a scheme of this kind does not support `friction`; `None` if it does. The text continues a sentence
    /// about the scheme.
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

/// Returns the schemes that support `friction`, in the order of the table.
pub fn true_to(friction: Friction) -> impl Iterator<Item = &'static SchemeInfo> + Clone {
    SCHEMES
        .iter()
        .filter(move |scheme| scheme.admits.why_not(&friction).is_none())
}

/// Returns the names of all schemes, in the order of the table.
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
    /// Returns the scheme with this name.
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
