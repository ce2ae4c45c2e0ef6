//! Which driver a study tests: one of the catalogue, a network, or one that the program brings itself.

use super::network::{Network, is_network};
use crate::Error;
use paracosm_coverage::Record;
use paracosm_engine::driver::{self, Driver};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

/// A driver with all its settings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DriverChoice {
    /// Its name.
    pub name: String,
    settings: Record<f64>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    network: Option<Network>,
    #[serde(skip)]
    own: Option<Own>,
}

/// How a driver is made that is not in the catalogue.
#[derive(Clone)]
struct Own(Arc<dyn Fn() -> Box<dyn Driver> + Send + Sync>);

impl fmt::Debug for Own {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Own")
    }
}

impl PartialEq for Own {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl DriverChoice {
    /// The driver of this name in a scenario: one of the catalogue, or a network.
    pub(super) fn new(name: &str, changes: &[(String, f64)], scenario: &str) -> Result<Self, Error> {
        let (mut network, mut settings) = (None, Record::default());
        if is_network(name) {
            network = Some(Network::of(name, scenario)?);
            if let Some((setting, _)) = changes.first() {
                return Err(Error::Usage(format!("driver `{name}` is a network and has no setting `{setting}`")));
            }
        } else {
            let found = driver::find(name)?.settings(changes)?;
            settings = found.iter().map(|(name, value)| (name.to_owned(), value)).collect();
        }
        Ok(Self { name: name.to_owned(), settings, network, own: None })
    }

    /// A driver that is not in the catalogue.
    pub(super) fn own(name: &str, make: impl Fn() -> Box<dyn Driver> + Send + Sync + 'static) -> Self {
        Self { name: name.to_owned(), settings: Record::default(), network: None, own: Some(Own(Arc::new(make))) }
    }

    /// A new driver of this kind.
    ///
    /// # Errors
    /// The choice was read from a file and there is no such driver, setting or network.
    pub fn build(&self) -> Result<Box<dyn Driver>, Error> {
        match (&self.own, &self.network) {
            (Some(Own(make)), _) => Ok(make()),
            (None, Some(network)) => network.driver(&self.name),
            (None, None) => {
                let settings: Vec<_> = self.settings.iter().map(|(name, value)| (name.to_owned(), *value)).collect();
                Ok(driver::find(&self.name)?.build(&settings)?)
            }
        }
    }
}
