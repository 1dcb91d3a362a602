//! Pointers of the caller as references and slices, checked as far as they can be.
//!
//! # Safety
//! All of these need what the documentation of every C function asks of its caller: pointers are null or point to as
//! many elements as are said, which stay as they are, but for what the call writes, until it returns.

use std::slice;

use library::{Directions, StokesSpectra};

use crate::guard::{Failure, Outcome};

type Check = Outcome<()>;

fn check<T>(pointer: *const T, what: &'static str) -> Check {
    if pointer.is_null() {
        return Err(Failure::Null(what));
    }
    match pointer.is_aligned() {
        true => Ok(()),
        false => Err(Failure::Alignment(what)),
    }
}

fn check_array<T>(pointer: *const T, count: usize, what: &'static str) -> Check {
    check(pointer, what)?;
    match count.checked_mul(size_of::<T>()) {
        Some(bytes) if isize::try_from(bytes).is_ok() => Ok(()),
        _ => Err(Failure::Length(what, count)),
    }
}

/// Something to read.
#[inline(always)]
pub unsafe fn shared<'a, T>(pointer: *const T, what: &'static str) -> Outcome<&'a T> {
    check(pointer, what)?;
    // SAFETY: the caller's part.
    Ok(unsafe { &*pointer })
}

/// Something to change.
#[inline(always)]
pub unsafe fn exclusive<'a, T>(pointer: *mut T, what: &'static str) -> Outcome<&'a mut T> {
    check(pointer, what)?;
    // SAFETY: the caller's part.
    Ok(unsafe { &mut *pointer })
}

/// An array to read; null if it is empty.
#[inline(always)]
pub unsafe fn slice<'a, T>(
    pointer: *const T,
    count: usize,
    what: &'static str,
) -> Outcome<&'a [T]> {
    if count == 0 {
        return Ok(&[]);
    }
    check_array(pointer, count, what)?;
    // SAFETY: the caller's part.
    Ok(unsafe { slice::from_raw_parts(pointer, count) })
}

/// An array to write; null if it is empty.
#[inline(always)]
pub unsafe fn slice_mut<'a, T>(
    pointer: *mut T,
    count: usize,
    what: &'static str,
) -> Outcome<&'a mut [T]> {
    if count == 0 {
        return Ok(&mut []);
    }
    check_array(pointer, count, what)?;
    // SAFETY: the caller's part.
    Ok(unsafe { slice::from_raw_parts_mut(pointer, count) })
}

/// A few numbers, copied.
#[inline(always)]
pub unsafe fn array<T: Copy, const N: usize>(
    pointer: *const T,
    what: &'static str,
) -> Outcome<[T; N]> {
    check(pointer, what)?;
    // SAFETY: the caller's part; an array is aligned as its elements are.
    Ok(unsafe { *pointer.cast::<[T; N]>() })
}

/// Writes a value.
#[inline(always)]
pub unsafe fn put<T>(pointer: *mut T, value: T, what: &'static str) -> Check {
    check(pointer, what)?;
    // SAFETY: the caller's part.
    unsafe { pointer.write(value) };
    Ok(())
}

/// Writes a few numbers.
#[inline(always)]
pub unsafe fn put_array<T, const N: usize>(
    pointer: *mut T,
    values: [T; N],
    what: &'static str,
) -> Check {
    // SAFETY: the caller's part; an array is aligned as its elements are.
    unsafe { put(pointer.cast::<[T; N]>(), values, what) }
}

/// Gives the caller a new handle; null if there is none.
pub unsafe fn give<T>(out: *mut *mut T, make: impl FnOnce() -> Outcome<T>) -> Check {
    // SAFETY: the caller's part.
    unsafe {
        put(out, std::ptr::null_mut(), "the new handle")?;
        let made = make()?;
        put(out, Box::into_raw(Box::new(made)), "the new handle")
    }
}

/// Where an array lies.
#[derive(Clone, Copy)]
pub struct Span {
    start: usize,
    end: usize,
}

/// Of `count` elements.
#[inline(always)]
pub fn span<T>(pointer: *const T, count: usize) -> Span {
    let start = pointer.addr();
    let end = start.saturating_add(count.saturating_mul(size_of::<T>()));
    Span { start, end }
}

/// Whether no output overlaps an input or another output.
#[inline(always)]
pub fn apart<const N: usize, const M: usize>(inputs: [Span; N], outputs: [Span; M]) -> Check {
    let meets = |a: &Span, b: &Span| a.start < b.end && b.start < a.end;
    for (i, output) in outputs.iter().enumerate() {
        let mut others = inputs.iter().chain(&outputs[..i]);
        if others.any(|other| meets(output, other)) {
            return Err(Failure::Overlap);
        }
    }
    Ok(())
}

/// Directions as three arrays.
#[inline(always)]
pub unsafe fn directions<'a>([x, y, z]: [*const f32; 3], count: usize) -> Outcome<Directions<'a>> {
    // SAFETY: the caller's part.
    unsafe {
        Ok(Directions {
            x: slice(x, count, "x")?,
            y: slice(y, count, "y")?,
            z: slice(z, count, "z")?,
        })
    }
}

/// How many directions of a batch are turned to three arrays at once, on the stack.
pub(crate) const BLOCK: usize = 128;

/// Hands over directions as three arrays, some at a time, with the index of the first.
pub fn in_blocks(
    directions: &[[f32; 3]],
    mut body: impl FnMut(usize, &Directions) -> library::Result<()>,
) -> Outcome<()> {
    let mut arrays = [[0.0; BLOCK]; 3];
    for (block, directions) in directions.chunks(BLOCK).enumerate() {
        for (i, direction) in directions.iter().enumerate() {
            for (array, component) in arrays.iter_mut().zip(direction) {
                array[i] = *component;
            }
        }
        let [x, y, z] = arrays.each_ref().map(|array| &array[..directions.len()]);
        body(block * BLOCK, &Directions { x, y, z })?;
    }
    Ok(())
}

/// Whether an output has the length that it must have.
pub fn check_count(got: usize, expected: usize) -> Check {
    if got == expected {
        return Ok(());
    }
    let [expected, got] = [expected, got].map(|n| n as u64);
    Err(library::Error::Length {
        what: "output",
        expected,
        got,
    }
    .into())
}

/// Copies numbers to an array of the caller.
pub unsafe fn copy<T: Copy>(from: &[T], to: *mut T, count: usize) -> Check {
    check_count(count, from.len())?;
    // SAFETY: the caller's part.
    unsafe { slice_mut(to, count, "output")? }.copy_from_slice(from);
    Ok(())
}

/// Room for Stokes vectors as three arrays.
pub unsafe fn spectra<'a>(parts: [*mut f32; 3], count: usize) -> Outcome<StokesSpectra<'a>> {
    apart([], parts.map(|part| span(part, count)))?;
    let [i, q, u] = parts;
    // SAFETY: the caller's part.
    unsafe {
        Ok(StokesSpectra {
            i: slice_mut(i, count, "i")?,
            q: slice_mut(q, count, "q")?,
            u: slice_mut(u, count, "u")?,
        })
    }
}
