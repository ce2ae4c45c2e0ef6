//! The states of the elements of a storyboard, and the transitions between them.

/// The state of an element, or the transition that the element has just made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum State {
    Standby,
    Running,
    Complete,
    StartTransition,
    EndTransition,
    StopTransition,
    SkipTransition,
}

impl State {
    pub const NAMES: [(&str, Self); 7] = [
        ("standbyState", Self::Standby),
        ("runningState", Self::Running),
        ("completeState", Self::Complete),
        ("startTransition", Self::StartTransition),
        ("endTransition", Self::EndTransition),
        ("stopTransition", Self::StopTransition),
        ("skipTransition", Self::SkipTransition),
    ];

    /// Returns `true` for a transition, and `false` for a state.
    pub fn is_transition(self) -> bool {
        !matches!(self, Self::Standby | Self::Running | Self::Complete)
    }
}
