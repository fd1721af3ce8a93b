//! Whether bodies passed through each other, as far as the states of a run tell.

use carom_dynamics::{Certificate, Crossing, State, StepReport, System, Told};

/// What the states taken so far tell.
#[derive(Debug, Default)]
pub(crate) struct Crossings {
    certificate: Option<Certificate>,
    /// What was told until a checkpoint, before the run has gone on from it.
    kept: Option<Told>,
    /// Whether states were taken that are not whole.
    partial: bool,
}

impl Crossings {
    /// Takes an accepted state.
    pub(crate) fn push(&mut self, system: &System, state: &State, report: &StepReport) {
        self.partial |= report.partial;
        if self.partial {
            self.certificate = None;
            return;
        }
        match &mut self.certificate {
            Some(certificate) => certificate.take(system, state),
            None => self.certificate = Some(Certificate::begin(system, state)),
        }
    }

    /// What a run needs to go on; nothing where it did not look.
    pub(crate) fn kept(&self) -> Option<&Told> {
        let told = self.certificate.as_ref().map(Certificate::told);
        told.or(self.kept.as_ref())
    }

    /// Takes what was told until a checkpoint.
    pub(crate) fn recall(&mut self, kept: Option<Told>) {
        self.partial = kept.is_none();
        self.kept = kept;
    }

    /// Goes on from the state of that checkpoint; whether that is of this system.
    pub(crate) fn go_on(&mut self, system: &System, state: &State) -> bool {
        let Some(told) = self.kept.take() else {
            return true;
        };
        self.certificate = Certificate::resume(system, state, told);
        self.certificate.is_some()
    }

    /// The certificate; none of a run on several ranks.
    pub(crate) fn certificate(&self) -> Option<&Certificate> {
        self.certificate.as_ref()
    }

    /// Those that passed through each other and are of some kind.
    pub(crate) fn those(&self, is: impl Fn(&Crossing) -> bool) -> Vec<&Crossing> {
        let told = self.certificate.iter().map(Certificate::told);
        let all = told.flat_map(|told| &told.crossings);
        all.filter(|crossing| is(crossing)).collect()
    }
}
