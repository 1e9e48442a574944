#pragma once
/// The largest errors of albedos that src/render/bsdf interpolates from its tables. The headers
/// state these errors, and table_errors_test measures them.

namespace microtrace::tables {

/// Statistics of the differences between value and integral: the maximum, the negated minimum, and
/// the root mean square.
struct StatedError {
  double above, below, rms;
};

/// Measured at equally spaced values of cos(theta) in a column, and of roughness.
inline constexpr StatedError kGgxF1Error{.above = 0.006, .below = 0.0006, .rms = 0.0004};
inline constexpr StatedError kGgxSchlickError{.above = 0.025, .below = 0.017, .rms = 0.0011};
/// Compared with the means of the interpolated albedos.
inline constexpr StatedError kGgxMeanF1Error{.above = 0.00012, .below = 0.00015, .rms = 0.00005};
inline constexpr StatedError kGgxMeanSchlickError{
    .above = 0.000001, .below = 0.000001, .rms = 0.000001};

/// The range of albedos of white metal with multiple scattering, for cos(theta) > 0.02.
inline constexpr double kLeastWhiteMetal = 0.9945, kMostWhiteMetal = 1.0007;

/// Measured at equally spaced rows and columns, from cos(theta) = 0.0001 on.
inline constexpr StatedError kSheenError{.above = 0.07, .below = 0.03, .rms = 0.006};
inline constexpr double kMostSheen = 1.01;  ///< maximum albedo of the divided model

/// Measured for a clear coat, over the roughness of coat and base, and sqrt(cos(theta)).
inline constexpr StatedError kDeficitF1Error{.above = 0.003, .below = 0.0045, .rms = 0.0005};
inline constexpr StatedError kDeficitSchlickError{.above = 0.003, .below = 0.003, .rms = 0.0003};

/// Measured for equal steps of all three table coordinates, from an index of 1.003.
inline constexpr StatedError kLossOutsideError{.above = 0.011, .below = 0.095, .rms = 0.006};
inline constexpr StatedError kLossWithinError{.above = 0.011, .below = 0.11, .rms = 0.0065};

/// The same for other Fresnel terms, with f0 <= f90 <= 1.
inline constexpr StatedError kAnyLossOutsideError{.above = 0.009, .below = 0.1, .rms = 0.007};
inline constexpr StatedError kAnyLossWithinError{.above = 0.008, .below = 0.11, .rms = 0.008};

/// Measured over roughness, strength, azimuth, and cos(theta). The cosine has equal steps of its
/// square root, or of the last variable of the loss.
inline constexpr StatedError kAnisotropicF1Error{.above = 0.016, .below = 0.0035, .rms = 0.0013};
inline constexpr StatedError kAnisotropicSchlickError{
    .above = 0.028, .below = 0.017, .rms = 0.0013};
/// Compared with the means of the polynomials.
inline constexpr StatedError kAnisotropicMeanF1Error{.above = 0, .below = 0.0022, .rms = 0.0016};
inline constexpr StatedError kAnisotropicMeanSchlickError{
    .above = 0.0003, .below = 0.00025, .rms = 0.0001};

}  // namespace microtrace::tables
