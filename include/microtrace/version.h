/* The version of the headers, for C and C++. CMakeLists.txt reads the version from this file. */
#ifndef MICROTRACE_VERSION_H
#define MICROTRACE_VERSION_H

#define MICROTRACE_VERSION_MAJOR 0
#define MICROTRACE_VERSION_MINOR 1
#define MICROTRACE_VERSION_PATCH 0

/* The version as a number for comparisons: 100 for 0.1.0. */
#define MICROTRACE_VERSION_NUMBER \
  (MICROTRACE_VERSION_MAJOR * 10000 + MICROTRACE_VERSION_MINOR * 100 + MICROTRACE_VERSION_PATCH)

/* The version as a string: "0.1.0". */
#define MICROTRACE_VERSION_QUOTED(x) #x
#define MICROTRACE_VERSION_JOINED(a, b, c) \
  MICROTRACE_VERSION_QUOTED(a) "." MICROTRACE_VERSION_QUOTED(b) "." MICROTRACE_VERSION_QUOTED(c)
#define MICROTRACE_VERSION_TEXT                                                 \
  MICROTRACE_VERSION_JOINED(MICROTRACE_VERSION_MAJOR, MICROTRACE_VERSION_MINOR, \
                            MICROTRACE_VERSION_PATCH)

#endif
