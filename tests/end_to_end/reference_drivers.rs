//! What the reference drivers of UN R157 get out of.

use super::common::golden;

#[allow(dead_code)]
#[path = "../../examples/cut_ins.rs"]
mod cut_ins;

#[test]
fn the_example_of_the_cut_ins_says_what_each_reference_driver_avoids() {
    golden("cut-ins.txt", &cut_ins::report().unwrap());
}
