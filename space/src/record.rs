//! Values by name that keep their order. Tests and the entries of a log are written as such records.

use serde::de::{Error as _, MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::HashSet;
use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;

/// A map from names to values that keeps the order in which the entries were given. JSON writes them as an object.
/// Every name occurs once.
#[derive(Debug, Clone, PartialEq)]
pub struct Record<T>(Vec<(Arc<str>, T)>);

/// The number of names up to which it is faster to compare all names than to hash them.
const FEW: usize = 32;

impl<T> Record<T> {
    /// The record without values.
    pub const EMPTY: Self = Self(Vec::new());

    /// Returns the value of the given name, or `None` if the record does not have the name.
    pub fn get(&self, name: &str) -> Option<&T> {
        self.iter().find(|(key, _)| *key == name).map(|(_, value)| value)
    }

    /// Returns the names with their values, in the order of the record.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &T)> {
        self.0.iter().map(|(name, value)| (&**name, value))
    }

    /// Sets the value of a name in the record. A value that the name already has is replaced and keeps its place.
    pub fn set(&mut self, name: impl Into<Arc<str>>, value: impl Into<T>) {
        let (name, value) = (name.into(), value.into());
        match self.0.iter_mut().find(|(key, _)| *key == name) {
            Some(entry) => entry.1 = value,
            None => self.0.push((name, value)),
        }
    }

    /// Takes the names from another record where both have the same name at the same place. Then both share the memory
    /// of the name. Releases memory that no value needs.
    pub fn share_names(&mut self, other: &Self) {
        for ((name, _), (others, _)) in self.0.iter_mut().zip(&other.0) {
            if name == others {
                name.clone_from(others);
            }
        }
        self.0.shrink_to_fit();
    }
}

impl<T> Default for Record<T> {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl<T, N: Into<Arc<str>>> FromIterator<(N, T)> for Record<T> {
    fn from_iter<I: IntoIterator<Item = (N, T)>>(entries: I) -> Self {
        Self(entries.into_iter().map(|(name, value)| (name.into(), value)).collect())
    }
}

impl<T: Serialize> Serialize for Record<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            map.serialize_entry(&**name, value)?;
        }
        map.end()
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Record<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = Record<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a map from names to values")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Record<T>, A::Error> {
                let mut record = Record::default();
                let mut names = HashSet::new();
                while let Some((name, value)) = map.next_entry::<String, T>()? {
                    let name: Arc<str> = name.into();
                    let count = record.0.len();
                    if count == FEW {
                        names = record.0.iter().map(|(name, _)| name.clone()).collect();
                    }
                    let is_new = if count < FEW { record.get(&name).is_none() } else { names.insert(name.clone()) };
                    if !is_new {
                        return Err(A::Error::custom(format!("found `{name}` twice, expected one value per name")));
                    }
                    record.0.push((name, value));
                }
                Ok(record)
            }
        }
        deserializer.deserialize_map(Entries(PhantomData))
    }
}
