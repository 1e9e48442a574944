#include "io/json/excerpt.hpp"

#include "base/text/printable.hpp"

#include <string>

#include <gmock/gmock.h>

namespace microtrace::io {
namespace {

using ::testing::StartsWith;

TEST(PlaceOf, CountsLinesAndBytes) {
  const std::string text = "ab\ncd\n";
  EXPECT_EQ(place_of(text, 0).column, 1U);
  EXPECT_EQ(place_of(text, 2).column, 3U);
  EXPECT_EQ(place_of(text, 3).line, 2U);
  EXPECT_EQ(place_of(text, 3).column, 1U);
  EXPECT_EQ(place_of(text, 6).line, 3U);
}

TEST(Excerpt, PutsTheCaretUnderThePlace) {
  EXPECT_EQ(excerpt("one\ntwo three\nfour", 8), "two three\n    ^");
  EXPECT_EQ(excerpt("one\r\ntwo", 1), "one\n ^");
  EXPECT_EQ(excerpt("one\ntwo", 3), "one\n   ^");
  EXPECT_EQ(excerpt("", 0), "\n^");
}

TEST(Excerpt, AlignsTheCaretAfterTabsAndOtherAlphabets) {
  EXPECT_EQ(excerpt("\t\ta b", 4), "  a b\n    ^");
  EXPECT_EQ(excerpt("\xC3\xA4\xE2\x82\xAC x", 6), "\xC3\xA4\xE2\x82\xAC x\n   ^");
}

TEST(Excerpt, EscapesTerminalControlBytes) {
  EXPECT_EQ(excerpt("\x1B[2J!", 4), "\\x1b[2J!\n       ^");
  EXPECT_EQ(excerpt("\xC2\x9B!", 2), "\\xc2\\x9b!\n        ^");
  EXPECT_EQ(excerpt("\xE2\x80\xAE!", 3), "\\xe2\\x80\\xae!\n            ^");
  EXPECT_EQ(excerpt("\xFF\xC0\x80!", 3), "\\xff\\xc0\\x80!\n            ^");
  EXPECT_EQ(printable("a\x07"), "a\\x07");
  // An Arabic letter mark, a soft hyphen, a Hangul filler and a tag letter
  EXPECT_EQ(printable("\u061C\u00AD"), "\\xd8\\x9c\\xc2\\xad");
  EXPECT_EQ(printable("\u3164\U000E0041"), "\\xe3\\x85\\xa4\\xf3\\xa0\\x81\\x81");
  EXPECT_EQ(printable("\u00E9\u2764\uFE0F"), "\u00E9\u2764\uFE0F");
}

TEST(Excerpt, CutsLongLines) {
  const std::string line(1000, 'x');
  const std::string shown = excerpt(line, 500);
  EXPECT_EQ(shown, "..." + std::string(120, 'x') + "...\n" + std::string(83, ' ') + "^");
  EXPECT_EQ(excerpt(line.substr(0, 120), 119),
            line.substr(0, 120) + "\n" + std::string(119, ' ') + "^");
  EXPECT_THAT(excerpt(line, 3), StartsWith(std::string(120, 'x') + "...\n   ^"));
}

TEST(Excerpt, TruncatesBetweenCharacters) {
  std::string line;
  for (int i = 0; i < 300; ++i) line += "\xE2\x82\xAC";
  for (std::size_t i = 300; i < 312; i += 3) {
    EXPECT_EQ(excerpt(line, i).find("\\x"), std::string::npos) << i;
  }
}

TEST(Quoted, TruncatesAndEscapes) {
  EXPECT_EQ(in_quotes("abc"), "\"abc\"");
  EXPECT_EQ(in_quotes("a\nb"), "\"a\\x0ab\"");
  EXPECT_EQ(in_quotes(std::string(61, 'a')), "\"" + std::string(60, 'a') + "...\"");
}

}  // namespace
}  // namespace microtrace::io
