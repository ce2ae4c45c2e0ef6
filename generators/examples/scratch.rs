use paracosm_coverage::kwise::kwise_coverage;
use paracosm_coverage::{Domain, Parameter, Space, Value};
use paracosm_generators::covering::{CoveringRequest, covering_array};
use std::time::Instant;
fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let n: usize = args[0].parse().unwrap();
    let m: usize = args[1].parse().unwrap();
    let generate = args[2] == "gen";
    let names = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j","k","l","m","n"];
    let p = |name: &str| Parameter::new(name, Domain::Choice((0..n).map(|l| Value::Number(l as f64)).collect()));
    let t = Instant::now();
    let space = Space::new(names[..m].iter().map(|x| p(x)).collect()).unwrap().with_constraints(&args[3..]).unwrap();
    println!("clauses {:.3}", t.elapsed().as_secs_f64());
    let t = Instant::now();
    let rules = match space.rules() { Ok(r) => r, Err(e) => { println!("{e} {:.3}", t.elapsed().as_secs_f64()); return } };
    println!("rules {:.3} tests {:?}", t.elapsed().as_secs_f64(), rules.tests());
    let t = Instant::now();
    let all: Vec<usize> = (0..m).collect();
    println!("count {:?} {:.3}", rules.count(&all, 2), t.elapsed().as_secs_f64());
    let t = Instant::now();
    let first = rules.completes(&vec![None; m]).unwrap();
    let cov = kwise_coverage(&rules, 2, std::iter::once(first.as_slice())).unwrap();
    println!("measure {} of {} {:.3}", cov.covered, cov.valid, t.elapsed().as_secs_f64());
    if generate {
        let t = Instant::now();
        let array = covering_array(&CoveringRequest::new(&rules, 2)).unwrap();
        println!("generate {} {:.3}", array.rows.len(), t.elapsed().as_secs_f64());
        let t = Instant::now();
        let cov = kwise_coverage(&rules, 2, array.rows.iter().map(Vec::as_slice)).unwrap();
        println!("measure {} of {} {:.3}", cov.covered, cov.valid, t.elapsed().as_secs_f64());
    }
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    println!("{}", status.lines().find(|l| l.starts_with("VmHWM")).unwrap());
}
