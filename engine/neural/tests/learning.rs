//! What a network learns, what becomes of it as a file, and which files of others are drivers.
#![cfg(feature = "train")]

use paracosm_engine::driver::Driver;
use paracosm_engine::sensor::{Image, Look, Rig};
use paracosm_engine::{Briefing, Observation, vehicle::Vehicle};
use paracosm_neural::learn::{Learner, Lesson, Recipe};
use paracosm_neural::{Model, Pilot};
use prost::Message;
use tract_onnx::pb::tensor_proto::DataType;
use tract_onnx::pb::tensor_shape_proto::{Dimension, dimension};
use tract_onnx::pb::{
    GraphProto, ModelProto, NodeProto, OperatorSetIdProto, StringStringEntryProto, TensorShapeProto, TypeProto,
    ValueInfoProto, type_proto,
};

const SIZE: u32 = 33;

fn recipe(seed: u64) -> Recipe {
    Recipe {
        resolution: [SIZE, SIZE],
        look: Look::Textured,
        seed,
        batch: 8,
        rates: [2e-3, 5e-4],
        weights: [1.0, 1.0],
        held_out: Some(4),
    }
}

/// A bright post on a dark plain: the expert steers to where it stands, and brakes the faster it goes.
fn lessons() -> Vec<Lesson> {
    let lesson = |i: usize| {
        let post = 4 + 5 * (i % 6);
        let speed = (i / 6 % 5) as f32 * 5.0;
        let pixel = |at: usize| if at % SIZE as usize / 3 == post / 3 { [230, 220, 210] } else { [40, 50, 60] };
        let rgb = (0..(SIZE * SIZE) as usize).flat_map(pixel).collect();
        Lesson { run: i, rgb, speed, control: [post as f32 / 33.0 - 0.5, 0.5 - speed / 20.0] }
    };
    (0..60).map(lesson).collect()
}

fn image(lesson: &Lesson) -> Image {
    Image { camera: 0, number: 0, time: 0.0, width: SIZE, height: SIZE, rgb: lesson.rgb.clone() }
}

fn root_mean_square(model: &Model, lessons: &[Lesson]) -> f32 {
    let squares = lessons.iter().map(|lesson| {
        let answer = model.answer(&image(lesson), lesson.speed.into()).expect("an answer");
        (0..2).map(|i| (answer[i] - lesson.control[i]).powi(2)).sum::<f32>()
    });
    (squares.sum::<f32>() / lessons.len() as f32).sqrt()
}

#[test]
fn a_network_learns_to_answer_as_the_expert_and_drives_so_as_a_file() {
    let lessons = lessons();
    let mut learner = Learner::new(recipe(1));
    let ignorant = Model::read(&learner.onnx("")).expect("a driver");
    let mut progress = Vec::new();
    learner.learn(&lessons, 25, |step| progress.push(step));
    let model = Model::read(&learner.onnx("a test")).expect("a driver");
    assert_eq!((model.resolution(), model.look()), ([SIZE, SIZE], Look::Textured));
    let (before, after) = (root_mean_square(&ignorant, &lessons), root_mean_square(&model, &lessons));
    assert!(after < 0.1 && after < 0.2 * before, "{before} before, {after} after");
    assert!(progress[24].loss < 0.1 * progress[0].loss, "{progress:?}");
    // What is said of the runs that are held out is what the file does on them.
    let held_out: Vec<Lesson> = lessons.into_iter().filter(|lesson| lesson.run % 4 == 3).collect();
    let [steering, throttle] = progress[24].held_out.expect("some are held out");
    let said = (steering * steering + throttle * throttle).sqrt() as f32;
    let found = root_mean_square(&model, &held_out);
    assert!((said - found).abs() < 1e-4, "{said} said, {found} found");
}

#[test]
fn a_network_follows_from_its_seed() {
    let lessons = lessons();
    let file = |seed: u64| {
        let mut learner = Learner::new(recipe(seed));
        learner.learn(&lessons, 2, |_| ());
        learner.onnx("")
    };
    let first = file(1);
    assert!(first == file(1));
    assert!(first != file(2));
}

fn value(name: &str, shape: &[i64]) -> ValueInfoProto {
    // What is below zero is left open.
    let size = |&size: &i64| match size {
        0.. => dimension::Value::DimValue(size),
        _ => dimension::Value::DimParam("batch".to_owned()),
    };
    let dim = shape.iter().map(|known| Dimension { value: Some(size(known)), ..Dimension::default() }).collect();
    let tensor = type_proto::Tensor { elem_type: DataType::Float as i32, shape: Some(TensorShapeProto { dim }) };
    let of_tensor = TypeProto { value: Some(type_proto::Value::TensorType(tensor)), ..TypeProto::default() };
    ValueInfoProto { name: name.to_owned(), r#type: Some(of_tensor), ..ValueInfoProto::default() }
}

/// A file with these inputs and one operation, from the first input or the second to the output.
fn file(inputs: &[&[i64]], (operation, from): (&str, usize), output: &[i64]) -> Vec<u8> {
    let names = ["image", "speed", "more"];
    let node = NodeProto {
        input: vec![names[from].to_owned()],
        output: vec!["control".to_owned()],
        op_type: operation.to_owned(),
        ..NodeProto::default()
    };
    let graph = GraphProto {
        name: "other".to_owned(),
        node: vec![node],
        input: inputs.iter().zip(names).map(|(shape, name)| value(name, shape)).collect(),
        output: vec![value("control", output)],
        ..GraphProto::default()
    };
    let opset_import = vec![OperatorSetIdProto { domain: String::new(), version: 13 }];
    ModelProto { ir_version: 8, opset_import, graph: Some(graph), ..ModelProto::default() }.encode_to_vec()
}

#[test]
fn a_network_sees_the_look_that_its_file_names_and_by_default_the_look_flat() {
    let seeing = |look: Option<&str>| {
        let contents = Learner::new(Recipe { look: Look::Flat, ..recipe(1) }).onnx("");
        let mut model = ModelProto::decode(&contents[..]).expect("it was just written");
        assert!(model.metadata_props.is_empty(), "{:?}", model.metadata_props);
        let named = |name: &str| StringStringEntryProto { key: "look".to_owned(), value: name.to_owned() };
        model.metadata_props.extend(look.map(named));
        Model::read(&model.encode_to_vec()).map(|model| (model.look(), Pilot::new(model).equipment().cameras.look))
    };
    assert_eq!(seeing(None).expect("a driver"), (Look::Flat, Look::Flat));
    assert_eq!(seeing(Some("textured")).expect("a driver"), (Look::Textured, Look::Textured));
    let message = seeing(Some("texture")).expect_err("no such look").to_string();
    assert!(message.contains("the property `look`") && message.contains("did you mean `textured`?"), "{message}");
}

#[test]
fn a_file_that_is_no_driver_says_what_it_has_and_what_is_expected() {
    let image: &[i64] = &[1, 3, 40, 100];
    let said = |contents: &[u8]| Model::read(contents).map_or_else(|error| error.to_string(), |_| "nothing".to_owned());
    for (contents, words) in [
        (b"no model".to_vec(), vec!["cannot be read"]),
        (file(&[&[1, 1, 40, 100]], ("Flatten", 0), &[1, 4000]), vec!["first input", "1,1,40,100", "1 x 3 x height"]),
        (file(&[&[1, 3, -1, 100]], ("Flatten", 0), &[1, 2]), vec!["first input", "1 x 3 x height"]),
        (file(&[&[1, 3, 4, 100]], ("Flatten", 0), &[1, 1200]), vec!["first input", "from 8 to 1024"]),
        (file(&[image, &[1, 3]], ("Flatten", 0), &[1, 12000]), vec!["second input", "1,3", "1 x 1"]),
        (file(&[image, &[1, 1], &[1, 1]], ("Flatten", 0), &[1, 12000]), vec!["input is 3 tensors"]),
        (file(&[image], ("Flatten", 0), &[1, 12000]), vec!["output", "12000", "1 x 2"]),
        (file(&[image], ("Conundrum", 0), &[1, 2]), vec!["the operation `Conundrum`, which is not run"]),
    ] {
        let message = said(&contents);
        for word in words {
            assert!(message.contains(word), "`{word}` is missing in: {message}");
        }
    }
}

#[test]
fn a_first_dimension_may_be_left_open() {
    let mut contents = ModelProto::decode(&*Learner::new(recipe(1)).onnx("")).expect("a model");
    let graph = contents.graph.as_mut().expect("a graph");
    (graph.input[0], graph.input[1]) = (value("image", &[-1, 3, 33, 33]), value("speed", &[-1, 1]));
    graph.output[0] = value("control", &[-1, 2]);
    let model = Model::read(&contents.encode_to_vec()).expect("a driver");
    assert_eq!(model.resolution(), [33, 33]);
}

#[test]
fn a_pilot_mounts_a_camera_of_its_models_size_and_does_nothing_until_it_sees() {
    let model = Model::read(&Learner::new(recipe(3)).onnx("")).expect("a driver");
    let mut pilot = Pilot::new(model.clone());
    let cameras = pilot.equipment().cameras;
    assert_eq!(cameras.all["front"].resolution, [SIZE, SIZE]);
    pilot
        .reset(&Briefing { cruise_speed: 10.0, vehicle: Vehicle::BMW_320I, navigation: None })
        .expect("it drives any car");
    let observation = Observation { speed: 12.0, ..Observation::default() };
    let control = pilot.step(&observation).expect("an answer");
    assert_eq!((control.steering, control.throttle), (0.0, 0.0));
    let seen = image(&lessons()[7]);
    pilot.perceive(&Rig::default(), std::slice::from_ref(&seen)).expect("it looks");
    let control = pilot.step(&observation).expect("an answer");
    let [steering, throttle] = model.answer(&seen, 12.0).expect("an answer").map(f64::from);
    assert_eq!((control.steering, control.throttle), (steering, throttle));
    assert!((steering, throttle) != (0.0, 0.0));
}
