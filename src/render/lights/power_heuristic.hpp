#pragma once
namespace microtrace {

/// The power heuristic for numbers or lanes (E. Veach, Robust Monte Carlo methods for light
/// transport simulation, 1997, section 9.2.2).
template <class F>
F power_heuristic(const F& pdf, const F& other) {
  const F square = pdf * pdf;
  return square / (square + other * other);
}

}  // namespace microtrace
