#pragma once
namespace microtrace {

/// E. Veach, Robust Monte Carlo methods for light transport simulation, 1997, section 9.2.2; of
/// numbers or lanes.
template <class F>
F power_heuristic(const F& pdf, const F& other) {
  const F square = pdf * pdf;
  return square / (square + other * other);
}

}  // namespace microtrace
