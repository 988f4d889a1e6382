//! Hints for a compiler on the order of instructions: they change no result.

/// Scheduling barriers. Each returns its operands; a backend that gains nothing from one leaves it
/// out.
pub trait Schedule: Sized {
    /// Barrier after a number, on one lane of x86-64: LLVM computes the number by itself, not as
    /// one lane of several whose unused ones raise exceptions or hold denormals.
    #[inline(always)]
    #[must_use]
    fn alone(self) -> Self {
        self
    }

    /// Barrier after two numbers, with AVX2: neither is used before both are computed.
    ///
    /// Compilers tend to emit two dependency chains one after the other, because that takes fewer
    /// registers. A CPU that looks a hundred instructions ahead then waits for each in turn.
    #[inline(always)]
    fn interleave(a: Self, b: Self) -> (Self, Self) {
        (a, b)
    }

    /// Barrier after three numbers, on x86-64 without AVX: they are computed side by side. Compilers tend to compute each where it
    /// is used, and keep what it is made of in memory until then.
    #[inline(always)]
    #[must_use]
    fn together(three: [Self; 3]) -> [Self; 3] {
        three
    }

    /// [`interleave`](Self::interleave) of the two halves of a pair; others are returned unchanged.
    #[inline(always)]
    #[must_use]
    fn interleaved(self) -> Self {
        self
    }
}
