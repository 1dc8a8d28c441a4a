//! A composition as a scheme.

use super::{Kind, Splitting};
use crate::physics::workings::Phase;
use crate::physics::{Body, Loads, Scheme, State};

/// A splitting of one kind for one body; see [`super`].
#[derive(Clone, Debug)]
pub struct SplittingScheme {
    body: Body,
    kind: Kind,
    splitting: Splitting,
}

impl SplittingScheme {
    /// The scheme of that `kind` for `body`.
    pub fn new(kind: Kind, body: &Body) -> Self {
        let splitting = Splitting::new(kind, &body.inertia(), &Loads::default().moment(body));
        Self {
            body: body.clone(),
            kind,
            splitting,
        }
    }
}

impl Scheme for SplittingScheme {
    fn start(&mut self, _: &State) {}

    fn load(&mut self, loads: &Loads) {
        self.splitting = Splitting::new(self.kind, &self.body.inertia(), &loads.moment(&self.body));
    }

    fn step(&mut self, dt: f64, state: &mut State) {
        self.splitting.step(state, dt);
    }

    fn explain(&mut self, dt: f64, state: &mut State, phases: &mut Vec<Phase>) {
        self.splitting.step_heard(state, dt, phases);
    }

    fn boxed(&self) -> Box<dyn Scheme> {
        Box::new(self.clone())
    }
}
