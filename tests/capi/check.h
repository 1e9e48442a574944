/* Counts the checks of a test that fail. */
#ifndef MICROTRACE_TESTS_CAPI_CHECK_H
#define MICROTRACE_TESTS_CAPI_CHECK_H

#include <microtrace/microtrace.h>

#include <stdio.h>

static int failures = 0;

#define CHECK(condition)                                                           \
  do {                                                                             \
    if (!(condition)) {                                                            \
      printf("%s:%d: %s (%s)\n", __FILE__, __LINE__, #condition, mt_last_error()); \
      ++failures;                                                                  \
    }                                                                              \
  } while (0)

#endif
