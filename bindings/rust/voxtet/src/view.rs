use std::fmt;
use std::marker::PhantomData;
use std::ops::Index;

use crate::{Contact, ContactEvent, Pair, TouchEvent};

/// Records of the last step, in the library's memory. It borrows the grid, so that the next step cannot be made while it
/// is in use.
#[derive(Clone, Copy)]
pub struct View<'grid, T> {
    data: *const T,
    byte_stride: usize,
    count: usize,
    grid: PhantomData<&'grid [T]>,
}

// SAFETY: only read, as a slice would be.
unsafe impl<T: Sync> Send for View<'_, T> {}
unsafe impl<T: Sync> Sync for View<'_, T> {}

impl<'grid, T: Copy> View<'grid, T> {
    /// SAFETY: `count` records, `byte_stride` apart, that live and stay as they are for 'grid.
    pub(crate) unsafe fn new(data: *const T, byte_stride: usize, count: u64) -> Self {
        Self { data, byte_stride, count: count as usize, grid: PhantomData }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The record at `index`, if there are so many.
    pub fn get(&self, index: usize) -> Option<&'grid T> {
        // SAFETY: within what new() was given.
        (index < self.count).then(|| unsafe { &*self.data.byte_add(index * self.byte_stride) })
    }

    /// One after the other, in canonical order.
    pub fn iter(&self) -> Iter<'grid, T> {
        Iter { view: *self, next: 0 }
    }

    /// All of them as a slice; `None` only with a later library, whose records are longer.
    pub fn as_slice(&self) -> Option<&'grid [T]> {
        if self.count == 0 {
            return Some(&[]);
        }
        // SAFETY: within what new() was given, and without gaps.
        (self.byte_stride == std::mem::size_of::<T>())
            .then(|| unsafe { std::slice::from_raw_parts(self.data, self.count) })
    }

    /// Copies that outlive the next step.
    pub fn to_vec(&self) -> Vec<T> {
        self.iter().copied().collect()
    }
}

impl<T: Copy> Index<usize> for View<'_, T> {
    type Output = T;

    fn index(&self, index: usize) -> &T {
        self.get(index).unwrap_or_else(|| panic!("index {index} of a view of {}", self.count))
    }
}

impl<T: Copy + fmt::Debug> fmt::Debug for View<'_, T> {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.debug_list().entries(self.iter()).finish()
    }
}

impl<'grid, T: Copy> IntoIterator for View<'grid, T> {
    type Item = &'grid T;
    type IntoIter = Iter<'grid, T>;

    fn into_iter(self) -> Iter<'grid, T> {
        self.iter()
    }
}

impl<'grid, T: Copy> IntoIterator for &View<'grid, T> {
    type Item = &'grid T;
    type IntoIter = Iter<'grid, T>;

    fn into_iter(self) -> Iter<'grid, T> {
        self.iter()
    }
}

/// Of a [`View`].
#[derive(Clone)]
pub struct Iter<'grid, T> {
    view: View<'grid, T>,
    next: usize,
}

impl<'grid, T: Copy> Iterator for Iter<'grid, T> {
    type Item = &'grid T;

    fn next(&mut self) -> Option<&'grid T> {
        let item = self.view.get(self.next)?;
        self.next += 1;
        Some(item)
    }

    // At once, for skip(): of many events, those that ended come last.
    fn nth(&mut self, n: usize) -> Option<Self::Item> {
        self.next = self.next.saturating_add(n).min(self.view.len());
        self.next()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.view.len() - self.next;
        (left, Some(left))
    }
}

impl<T: Copy> ExactSizeIterator for Iter<'_, T> {}

/// The contacts of the last step.
pub type Contacts<'grid> = View<'grid, Contact>;

/// The pairs that touched in the last step, and the contacts of each.
#[derive(Clone, Copy, Debug)]
pub struct Pairs<'grid> {
    pub(crate) pairs: View<'grid, Pair>,
    pub(crate) contacts: View<'grid, u32>,
}

impl<'grid> Pairs<'grid> {
    /// The pairs, sorted.
    pub fn iter(&self) -> Iter<'grid, Pair> {
        self.pairs.iter()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.pairs.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// The pair at `index`, if there are so many.
    pub fn get(&self, index: usize) -> Option<&'grid Pair> {
        self.pairs.get(index)
    }

    /// All pairs as a view.
    pub fn view(&self) -> View<'grid, Pair> {
        self.pairs
    }

    /// Indices in the contacts, pair by pair.
    pub fn contact_indices(&self) -> View<'grid, u32> {
        self.contacts
    }

    /// Indices of the contacts of a pair: first those of vertices of `body_a`.
    pub fn contacts_of(&self, pair: &Pair) -> &'grid [u32] {
        let all = self.contacts.as_slice().unwrap_or(&[]);
        let first = pair.first as usize;
        all.get(first..first + (pair.a_in_b + pair.b_in_a) as usize).unwrap_or(&[])
    }
}

/// What the last step changed: those that began, then those that persisted, then those that ended.
#[derive(Clone, Copy, Debug)]
pub struct Events<'grid, T: Copy> {
    pub(crate) all: View<'grid, T>,
    pub(crate) began: usize,
    pub(crate) persisted: usize,
}

impl<'grid, T: Copy> Events<'grid, T> {
    /// All of them.
    pub fn all(&self) -> View<'grid, T> {
        self.all
    }

    /// Those that began.
    pub fn began(&self) -> impl ExactSizeIterator<Item = &'grid T> + Clone {
        self.all.iter().take(self.began)
    }

    /// Those that persisted; none for events of single vertices.
    pub fn persisted(&self) -> impl ExactSizeIterator<Item = &'grid T> + Clone {
        self.all.iter().skip(self.began).take(self.persisted)
    }

    /// Those that ended.
    pub fn ended(&self) -> impl ExactSizeIterator<Item = &'grid T> + Clone {
        self.all.iter().skip(self.began + self.persisted)
    }
}

pub(crate) type TouchEvents<'grid> = Events<'grid, TouchEvent>;
pub(crate) type ContactEvents<'grid> = Events<'grid, ContactEvent>;

// Without the library, so that miri can run them.
#[cfg(test)]
mod tests {
    use super::*;

    fn check(view: View<'_, [u32; 3]>, expected: &[[u32; 3]]) {
        assert_eq!(view.len(), expected.len());
        assert_eq!(view.to_vec(), expected);
        assert_eq!(view.get(expected.len()), None);
        assert_eq!(view.iter().len(), expected.len());
        for n in 0..=expected.len() + 1 {
            assert_eq!(view.get(n), expected.get(n));
            assert_eq!(view.iter().nth(n), expected.get(n));
            assert!(view.iter().skip(n).eq(expected.iter().skip(n)));
        }
        assert_eq!(view.iter().nth(usize::MAX), None);
        assert_eq!(format!("{view:?}"), format!("{expected:?}"));
    }

    #[test]
    fn records_one_after_the_other() {
        let records = [[1, 2, 3], [4, 5, 6], [7, 8, 9]];
        let view = unsafe { View::new(records.as_ptr(), 12, 3) };
        check(view, &records);
        assert_eq!(view.as_slice(), Some(&records[..]));
        check(unsafe { View::new(std::ptr::null(), 12, 0) }, &[]);
        check(unsafe { View::new(std::ptr::null(), 0, 0) }, &[]);
    }

    // As a later library may have them.
    #[test]
    fn longer_records() {
        #[repr(C)]
        struct Longer([u32; 3], u64);
        let records: Vec<Longer> = (0..5).map(|i| Longer([i, i + 1, i + 2], u64::MAX)).collect();
        let view: View<'_, [u32; 3]> = unsafe { View::new(records.as_ptr().cast(), std::mem::size_of::<Longer>(), 5) };
        check(view, &records.iter().map(|r| r.0).collect::<Vec<_>>());
        assert_eq!(view.as_slice(), None);
    }
}
