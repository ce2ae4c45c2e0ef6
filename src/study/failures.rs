//! Whether a failure ends the campaign.

use super::Study;

impl Study {
    /// Ends the campaign with the first test, in the order of their indices, that violates a requirement.
    pub fn stop_at_first(mut self, stop: bool) -> Self {
        self.stop_at_first = stop;
        self
    }

    /// Whether the first violation ends the campaign.
    pub fn stops_at_first(&self) -> bool {
        self.stop_at_first
    }
}
