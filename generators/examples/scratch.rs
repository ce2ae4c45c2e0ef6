#![allow(missing_docs)]
#[allow(dead_code)]
#[path = "../../experiments/src/transmission.rs"]
mod transmission;
use paracosm_coverage::{Point, Space};
use paracosm_generators::{Request, Strategy};
const SPACE: &str = include_str!("../../experiments/systems/automatic-transmission.toml");
fn run(p: &Point, which: usize) -> f64 {
    let c = &p.continuous;
    let thr: Vec<f64> = c[..7].iter().map(|u| u * 100.0).collect();
    let brk: Vec<f64> = c[7..].iter().map(|u| u * 325.0).collect();
    let s = transmission::run(&thr, &brk);
    let maxrpm = |n: usize| s[..=n].iter().map(|s| s.rpm).fold(f64::MIN, f64::max);
    let maxspeed = |n: usize| s[..=n].iter().map(|s| s.speed).fold(f64::MIN, f64::max);
    let at6 = |n: usize, v: f64| (maxrpm(300) - 3000.0).max(v - maxspeed(n));
    match which {
        0 => 120.0 - maxspeed(200),
        1 => 4750.0 - maxrpm(100),
        2 => at6(40, 35.0),
        3 => at6(80, 50.0),
        _ => at6(200, 65.0),
    }
}
fn first(space: &Space, st: Strategy, seed: u64, which: usize, batch: usize) -> usize {
    let mut g = st.build(&Request { seed: Some(seed), ..Request::new(space, 300) }).unwrap();
    let mut done = 0;
    while done < 300 {
        let tests = g.ask(batch.min(300 - done));
        if tests.is_empty() {
            break;
        }
        let rob: Vec<f64> = tests.iter().map(|t| run(t, which)).collect();
        if let Some(i) = rob.iter().position(|r| *r < 0.0) {
            return done + i + 1;
        }
        g.tell(&tests, &rob.iter().map(|r| Some(*r)).collect::<Vec<_>>());
        done += tests.len();
    }
    1000
}
fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let from: u64 = args[0].parse().unwrap();
    let n: u64 = args[1].parse().unwrap();
    let space = Space::from_toml(SPACE).unwrap();
    for st in args[2].split(',') {
        let st: Strategy = st.parse().unwrap();
        print!("{:<12}", st.name());
        let reqs: Vec<usize> =
            args.get(3).map_or(vec![2, 3, 4], |t| t.split(',').map(|t| t.parse().unwrap()).collect());
        for which in reqs {
            let half = n / 2;
            let space = &space;
            let mut v: Vec<usize> = std::thread::scope(|scope| {
                let a = scope
                    .spawn(move || (from..from + half).map(|s| first(space, st, s, which, 16)).collect::<Vec<_>>());
                let b = scope
                    .spawn(move || (from + half..from + n).map(|s| first(space, st, s, which, 16)).collect::<Vec<_>>());
                [a.join().unwrap(), b.join().unwrap()].concat()
            });
            v.sort();
            let found = v.iter().filter(|v| **v < 1000).count();
            let mean = v.iter().map(|v| (*v).min(300)).sum::<usize>() as f64 / n as f64;
            print!("  {mean:>6.1} {:>4} ({found})", v[v.len() / 2].min(300));
        }
        println!();
    }
}
