//! Taylor series in time, as arrays of coefficients.

/// Order of the series. At 53 bits the cost per second of motion is lowest near 20 (Jorba and Zou, section 3.2).
pub(super) const SERIES_ORDER: usize = 22;

/// The k-th coefficient of a product of two series, from the products of their coefficients.
pub(super) fn convolve<T: core::ops::Add<Output = T>>(
    k: usize,
    product: impl Fn(usize, usize) -> T,
) -> T {
    (1..=k).fold(product(0, k), |sum, i| sum + product(i, k - i))
}
