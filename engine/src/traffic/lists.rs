//! Lists of items by lane, filled again at every tick.

use crate::road::LaneId;

/// Lists of items by lane, filled again at every tick.
#[derive(Debug)]
pub(super) struct Lists<T> {
    heads: Vec<u32>,
    nodes: Vec<Node<T>>,
    used: Vec<LaneId>,
}

#[derive(Debug)]
struct Node<T> {
    owner: u32,
    what: T,
    next: u32,
}

const NONE: u32 = u32::MAX;

impl<T> Lists<T> {
    pub fn new(lanes: usize, room: usize) -> Self {
        Self { heads: vec![NONE; lanes], nodes: Vec::with_capacity(room), used: Vec::with_capacity(room) }
    }

    pub fn clear(&mut self) {
        for lane in self.used.drain(..) {
            self.heads[lane.index()] = NONE;
        }
        self.nodes.clear();
    }

    pub fn add(&mut self, lane: LaneId, owner: usize, what: T) {
        let head = &mut self.heads[lane.index()];
        if *head == NONE {
            self.used.push(lane);
        }
        self.nodes.push(Node { owner: owner as u32, what, next: *head });
        *head = self.nodes.len() as u32 - 1;
    }

    /// Returns the items that were added for a lane, each with the index of its owner.
    pub fn on(&self, lane: LaneId) -> impl Iterator<Item = (usize, &T)> {
        let mut next = self.heads[lane.index()];
        std::iter::from_fn(move || {
            let node = self.nodes.get(next as usize)?;
            next = node.next;
            Some((node.owner as usize, &node.what))
        })
    }
}
