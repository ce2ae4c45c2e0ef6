//! The strategy of a program that uses the library: any generator that the program makes, such as a search of another package. Its
//! [`OwnStrategy`](crate::OwnStrategy) comes with the request.

use crate::GeneratorError;
use crate::strategy::{ANY, Descriptor, Look, MarkShape, Method, MethodKind, Strategy};

impl Strategy {
    /// The strategy of the program that uses the library, which the request has. It counts as adaptive, and gets the worst robustness of all
    /// requirements. The strategy is not in [`all`](Self::all), because it makes no tests itself.
    pub const OWN: Self = Self::of(&Descriptor {
        name: "own",
        about: "a sampler or search of the program that runs the campaign",
        dims: ANY,
        look: Look::hollow(0x00_0000, MarkShape::Diamond),
        method: Method(MethodKind::Search {
            seeks_a_failure: false,
            build: |_, request, _| match request.own {
                Some(own) => own.build(request),
                None => Err(GeneratorError::OwnIsMissing { name: None }),
            },
        }),
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Generator, OwnStrategy, Request};
    use paracosm_space::{Point, Space};

    /// A search that steps to the right after each result.
    struct Steps(f64);

    impl Generator for Steps {
        fn ask(&mut self, n: usize) -> Vec<Point> {
            vec![Point { continuous: vec![self.0], discrete: Vec::new() }; n.min(1)]
        }

        fn tell(&mut self, _: &[Point], _: &[Option<f64>]) {
            self.0 += 0.25;
        }
    }

    #[test]
    fn the_generator_of_a_program_proposes_the_tests_of_its_strategy() {
        let own = OwnStrategy::new("steps", |request| match request.space.dims() {
            1 => Ok(Box::new(Steps(0.0))),
            _ => Err(GeneratorError::OwnFailed { name: "steps".into(), why: "steps go along one axis".into() }),
        });
        let space = Space::unit_cube(1);
        let request = Request { own: Some(&own), ..Request::new(&space, 3) };
        let mut generator = Strategy::OWN.build(&request).unwrap();
        for expected in [0.0, 0.25, 0.5] {
            let tests = generator.ask(1);
            assert_eq!(tests[0].continuous, [expected]);
            generator.tell(&tests, &[Some(1.0)]);
        }
        let plane = Space::unit_cube(2);
        let error = |request: &Request| Strategy::OWN.build(request).err().expect("it cannot be built").to_string();
        assert!(error(&Request { own: Some(&own), ..Request::new(&plane, 3) }).contains("steps go along one axis"));
        let named = OwnStrategy::named("steps");
        assert!(error(&Request { own: Some(&named), ..request }).contains("give the strategy again"));
        assert!(error(&Request { own: None, ..request }).contains("only a program"));
        assert_eq!(named, own);
    }
}
