use super::damped::DampedStrang;
use super::{Kind, Splitting};
use crate::workings::{Listener, Nobody, Phase};
use crate::{Body, Loads, Scheme, State};

/// A composition as a scheme.
#[derive(Clone, Debug)]
pub struct SplittingScheme {
    body: Body,
    kind: Kind,
    splitting: Splitting,
    /// Takes the steps where there is friction.
    damped: Option<DampedStrang>,
    /// Work of friction in the step taken last, J.
    work: f64,
}

impl SplittingScheme {
    pub fn new(kind: Kind, body: &Body) -> Self {
        let splitting = Splitting::new(kind, &body.inertia(), &Loads::default().moment(body));
        Self {
            body: body.clone(),
            kind,
            splitting,
            damped: None,
            work: 0.0,
        }
    }

    #[inline]
    fn advance<L: Listener>(&mut self, dt: f64, state: &mut State, listener: &mut L) {
        match &self.damped {
            None => self.splitting.step(state, dt, listener),
            Some(damped) => self.work = damped.step(state, dt, listener),
        }
    }
}

impl Scheme for SplittingScheme {
    fn start(&mut self, _: &State) {}

    fn load(&mut self, loads: &Loads) {
        self.splitting = Splitting::new(self.kind, &self.body.inertia(), &loads.moment(&self.body));
        self.damped = DampedStrang::new(&self.body, loads).filter(|_| self.kind == Kind::Strang);
        self.work = 0.0;
    }

    fn step(&mut self, dt: f64, state: &mut State) {
        self.advance(dt, state, &mut Nobody);
    }

    fn explain(&mut self, dt: f64, state: &mut State, phases: &mut Vec<Phase>) {
        self.advance(dt, state, phases);
    }

    fn friction_work(&self) -> f64 {
        self.work
    }

    fn boxed(&self) -> Box<dyn Scheme> {
        Box::new(self.clone())
    }
}
