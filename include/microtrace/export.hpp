#pragma once
/// What a shared library shows of itself. All else is hidden.

#define MICROTRACE_EXPORT [[gnu::visibility("default")]]
#define MICROTRACE_HIDDEN [[gnu::visibility("hidden")]]  // for a class within an exported one
