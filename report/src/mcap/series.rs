//! The signals of a trace and the margins of requirements, each number with a topic of its own, so that any plot can show it.

use super::Recorded;
use super::tape::Tape;
use crate::margin::margins;
use foxglove::bytes::BufMut;
use foxglove::{Encode, Schema};
use paracosm_campaign::Error;
use paracosm_engine::signal::about;
use prost::{EncodeError, Message};
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet};
use std::io::{Seek, Write};

/// The value of a signal at a time.
#[derive(Clone, PartialEq, Message)]
struct Signal {
    #[prost(double, optional, tag = "1")]
    value: Option<f64>,
}

/// The bounds of the robustness of a requirement at a time; a bound that is infinite is absent.
#[derive(Clone, PartialEq, Message)]
struct Robustness {
    #[prost(double, optional, tag = "1")]
    lower: Option<f64>,
    #[prost(double, optional, tag = "2")]
    upper: Option<f64>,
}

impl Encode for Signal {
    type Error = EncodeError;

    fn get_schema() -> Option<Schema> {
        Some(schema("Signal", &["value"]))
    }

    fn get_message_encoding() -> String {
        "protobuf".to_owned()
    }

    fn encode(&self, buffer: &mut impl BufMut) -> Result<(), EncodeError> {
        Message::encode(self, buffer)
    }
}

impl Encode for Robustness {
    type Error = EncodeError;

    fn get_schema() -> Option<Schema> {
        Some(schema("Robustness", &["lower", "upper"]))
    }

    fn get_message_encoding() -> String {
        "protobuf".to_owned()
    }

    fn encode(&self, buffer: &mut impl BufMut) -> Result<(), EncodeError> {
        Message::encode(self, buffer)
    }
}

/// Returns the schema of a message of optional numbers with these names, numbered from 1.
fn schema(name: &str, numbers: &[&str]) -> Schema {
    let field = |(place, name): (usize, &&str)| FieldDescriptorProto {
        name: Some((*name).to_owned()),
        number: Some(place as i32 + 1),
        label: Some(Label::Optional.into()),
        r#type: Some(Type::Double.into()),
        ..FieldDescriptorProto::default()
    };
    let message = DescriptorProto {
        name: Some(name.to_owned()),
        field: numbers.iter().enumerate().map(field).collect(),
        ..DescriptorProto::default()
    };
    // Without a `syntax`, the file has the second version of the language, in which a number may be absent.
    let file = FileDescriptorProto {
        name: Some(format!("paracosm/{name}.proto")),
        package: Some("paracosm".to_owned()),
        message_type: vec![message],
        ..FileDescriptorProto::default()
    };
    Schema::new(format!("paracosm.{name}"), "protobuf", FileDescriptorSet { file: vec![file] }.encode_to_vec())
}

/// Adds the messages of all signals and margins.
pub(super) fn tell<W: Write + Seek>(recorded: &Recorded<'_>, tape: &mut Tape<W>) -> Result<(), Error> {
    let Some(trace) = recorded.trace else { return Ok(()) };
    let finite = |number: f64| number.is_finite().then_some(number);
    for (column, name) in trace.signals().iter().enumerate() {
        let unit = about(name).map_or("", |about| about.unit);
        let said = about(name).map_or("", |about| about.about);
        let topic = tape.topic::<Signal>(&topic("signals", name), &[("unit", unit), ("about", said)])?;
        for (tick, row) in trace.rows().enumerate() {
            tape.say(topic, tick as f64 * trace.dt(), &Signal { value: finite(row[column]) });
        }
    }
    for margin in margins(recorded.study, trace) {
        let facts = [("unit", margin.requirement.unit.as_str()), ("about", margin.requirement.text.as_str())];
        let topic = tape.topic::<Robustness>(&topic("requirements", &margin.requirement.id), &facts)?;
        for (tick, (lower, upper)) in margin.bounds.iter().enumerate() {
            let message = Robustness { lower: finite(*lower), upper: finite(*upper) };
            tape.say(topic, tick as f64 * trace.dt(), &message);
        }
    }
    Ok(())
}

/// Returns the topic of a signal or a requirement: `car.speed` is `/signals/car/speed`, because a dot ends a topic in the paths of Foxglove.
fn topic(group: &str, name: &str) -> String {
    format!("/{group}/{}", name.replace('.', "/"))
}
