#pragma once
/// Marks the symbols that a shared library exports. All others are hidden.

#define MICROTRACE_EXPORT [[gnu::visibility("default")]]
#define MICROTRACE_HIDDEN [[gnu::visibility("hidden")]]  // for a class within an exported one
