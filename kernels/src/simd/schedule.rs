//! Hints for a compiler on the order of instructions, which change no result.

/// Scheduling barriers. Each returns its operands; a backend that gains nothing from a barrier omits it.
pub trait Schedule: Sized {
    /// Barrier after a number, on one lane of x86-64: LLVM computes the number by itself, not as one lane of several whose unused
    /// lanes raise exceptions or hold denormals.
    #[inline(always)]
    #[must_use]
    fn alone(self) -> Self {
        self
    }

    /// Barrier like [`alone`](Self::alone), after a number whose register may hold results of a polynomial far out of its domain in the
    /// unused lanes: these hold copies of the number afterwards, and raise an exception only where the number does. One instruction.
    #[inline(always)]
    #[must_use]
    fn spread(self) -> Self {
        self
    }

    /// Barrier after two numbers, with AVX2: neither is used before both are computed.
    ///
    /// Compilers tend to emit two dependency chains one after the other, because that order takes fewer registers. A CPU that looks
    /// a hundred instructions ahead then waits for each chain in turn.
    #[inline(always)]
    fn interleave(a: Self, b: Self) -> (Self, Self) {
        (a, b)
    }

    /// Barrier after three numbers, on x86-64 without AVX: the numbers are computed side by side. Compilers tend to compute each
    /// where it is used, and to keep its operands in memory until then.
    #[inline(always)]
    #[must_use]
    fn together(three: [Self; 3]) -> [Self; 3] {
        three
    }

    /// Applies [`interleave`](Self::interleave) to the two halves of a pair; other lanes are returned unchanged.
    #[inline(always)]
    #[must_use]
    fn interleaved(self) -> Self {
        self
    }
}
