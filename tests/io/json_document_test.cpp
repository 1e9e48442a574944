#include "io/json/document.hpp"
#include "io/json/write.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

#include <gmock/gmock.h>

namespace microtrace::io {
namespace {

using ::testing::HasSubstr;
using Kind = JsonValue::Kind;

/// Collects the beginning of every token in the tree by the token's offset.
void collect(std::string_view text, const JsonValue& value, std::string& out) {
  out.append(text.substr(value.offset, 5)).append("|");
  for (const JsonValue& item : value.items()) collect(text, item, out);
  for (const auto& [key, member] : value.members()) {
    out.append(text.substr(member.key_offset, 3)).append(":");
    collect(text, member, out);
  }
}

Error error_of(std::string_view text) {
  try {
    const JsonDocument document(text, "s.json");
  } catch (const Error& error) {
    return error;
  }
  return {ErrorKind::internal, "", "no error"};
}

TEST(JsonDocument, KnowsWhereEveryTokenStarts) {
  const std::string_view text =
      "\xEF\xBB\xBF \r\n{ \"a\" :\t[null ,true,false , -12.5e+3,7 ], \"\\\"b\\\\\" : { } ,\n"
      "\"c\":\"x\\\"y\\u00e9,:\" ,\"d\":[[ ],[{\"e\":0 }] , -0], \"f\":[1.5]}";
  const JsonDocument document(text, "s.json");
  std::string found;
  collect(text, document.root(), found);
  EXPECT_EQ(found,
            "{ \"a\"|\"a\":[null|null |true,|false|-12.5|7 ], |\"\\\":{ } ,|\"c\":\"x\\\"y|"
            "\"d\":[[ ],|[ ],[|[{\"e\"|{\"e\":|\"e\":0 }] |-0], |\"f\":[1.5]|1.5]}|");
  EXPECT_EQ(document.root().find("\"b\\")->kind(), Kind::object);
  EXPECT_EQ(document.root().find("c")->string(), "x\"y\xC3\xA9,:");
}

TEST(JsonDocument, ReadsAScalarRoot) {
  for (const std::string_view text : {"null", " true", "1", "\"s\"", "  -1e3  "}) {
    const JsonDocument document(text, "s.json");
    EXPECT_EQ(document.root().offset, text.find_first_not_of(' ')) << text;
  }
}

TEST(JsonDocument, ReadsNumbersToTheLastBit) {
  const std::string_view text =
      "[0.1, 1e-400, -0, -0.0, 9007199254740993, 18446744073709551616, 4.9e-324,"
      " 1.7976931348623157e308]";
  const JsonDocument document(text, "s.json");
  const std::vector<JsonValue>& items = document.root().items();
  EXPECT_EQ(items[0].number(), 0.1);
  EXPECT_EQ(items[1].number(), 0);
  EXPECT_TRUE(std::signbit(items[2].number()));
  EXPECT_TRUE(std::signbit(items[3].number()));
  EXPECT_EQ(items[4].number(), 9007199254740992.0);
  EXPECT_EQ(items[5].number(), 0x1p64);
  EXPECT_EQ(items[6].number(), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(items[7].number(), std::numeric_limits<double>::max());
}

TEST(JsonValue, CopiesAreIndependent) {
  const JsonDocument document(R"({"a": [1, {"b": "text"}], "c": null})", "s.json");
  JsonValue copy = document.root();
  copy.find("a")->edit_items()[0].set(JsonValue(2.0));
  copy.add("d").set(JsonValue(true));
  copy.remove_members([](std::string_view key) { return key == "c"; });
  EXPECT_EQ(document.root().find("a")->items()[0].number(), 1);
  EXPECT_EQ(document.root().members().size(), 2U);
  ASSERT_EQ(copy.members().size(), 2U);
  EXPECT_EQ(copy.find("a")->find(0U)->number(), 2);
  EXPECT_EQ(copy.find("a")->find(1U)->find("b")->string(), "text");
  EXPECT_EQ(copy.find("a")->find(2U), nullptr);
  EXPECT_TRUE(copy.find("d")->boolean());
  EXPECT_EQ(copy.find("a")->offset, document.root().find("a")->offset);
  copy = copy.find("a")->items()[1];
  EXPECT_EQ(copy.members()[0].key, "b");
}

TEST(JsonValue, HasTheDefaultsOfOtherKinds) {
  const JsonValue null;
  EXPECT_FALSE(null.boolean());
  EXPECT_EQ(null.number(), 0);
  EXPECT_TRUE(null.string().empty() && null.items().empty() && null.members().empty());
  EXPECT_EQ(null.find("a"), nullptr);
}

struct BadText {
  std::string_view text;
  std::size_t line, column;
  std::string_view message;
};

class Refuses : public ::testing::TestWithParam<BadText> {};

TEST_P(Refuses, WithTheExactPlace) {
  const Error error = error_of(GetParam().text);
  EXPECT_EQ(error.kind(), ErrorKind::invalid_scene);
  EXPECT_EQ(error.diagnostic().line, GetParam().line) << error.what();
  EXPECT_EQ(error.diagnostic().column, GetParam().column) << error.what();
  EXPECT_EQ(error.diagnostic().message, GetParam().message);
}

using namespace std::string_view_literals;

INSTANTIATE_TEST_SUITE_P(
    JsonDocument, Refuses,
    ::testing::Values(
        BadText{"", 0, 0, "is empty"}, BadText{" \n\t ", 0, 0, "is empty"},
        BadText{"\xEF\xBB\xBF\n", 0, 0, "is empty"},
        BadText{"{", 1, 2, "expected a key in double quotes or '}', found the end of the text"},
        BadText{"{\"a\":[1,2", 1, 10, "expected ',' or ']', found the end of the text"},
        BadText{"{\"a\":1,\n  }", 1, 7, "a comma is not allowed before '}'; remove it"},
        BadText{"[1, ]", 1, 3, "a comma is not allowed before ']'; remove it"},
        BadText{"[,1]", 1, 2, "expected a value or ']', found ','"},
        BadText{"[1,,2]", 1, 4, "expected a value, found ','"},
        BadText{"[1 2]", 1, 4, "expected ',' or ']', found \"2\""},
        BadText{"[01]", 1, 3, "expected ',' or ']', found \"1\"; JSON numbers don't start with 0"},
        BadText{"[1-2]", 1, 3, "expected ',' or ']', found \"-2\""},
        BadText{"{\"a\" 1}", 1, 6, "expected ':' after the key, found \"1\""},
        BadText{"{\"a\"::1}", 1, 6, "expected a value, found ':'"},
        BadText{"{\"a\":}", 1, 6, "expected a value, found '}'"},
        BadText{"{a:1}", 1, 2, "expected a key in double quotes or '}', found \"a\""},
        BadText{"{\"a\":1 \"b\":2}", 1, 8, "expected ',' or '}', found a string"},
        BadText{"{1:2}", 1, 2, "expected a key in double quotes or '}', found \"1\""},
        BadText{"[1}", 1, 3, "expected ',' or ']', found '}'"},
        BadText{"[] []", 1, 4, "expected nothing more after the end of the JSON value, found '['"},
        BadText{"{}\n\0x"sv, 2, 1, "a zero byte is outside of strings; this is not a JSON text"},
        BadText{"\0\0\0"sv, 1, 1, "a zero byte is outside of strings; this is not a JSON text"},
        BadText{"[1,\0 2]"sv, 1, 4, "a zero byte is outside of strings; this is not a JSON text"},
        BadText{"[1 // one\n]", 1, 4, "comments are not JSON; remove it"},
        BadText{"/* */ []", 1, 1, "comments are not JSON; remove it"},
        BadText{"[1/3]", 1, 3, "expected ',' or ']', found \"/\""},
        BadText{"[1\xEF\xBC\x8C 2]", 1, 3,
                "expected ',' or ']', found \"\xEF\xBC\x8C\"; JSON needs the ASCII character ,"},
        BadText{
            "[\xEF\xBC\x91]", 1, 2,
            "expected a value or ']', found \"\xEF\xBC\x91\"; JSON needs the ASCII character 1"},
        BadText{"{\xEF\xBC\x82x\":1}", 1, 2,
                "expected a key in double quotes or '}', found \"\xEF\xBC\x82x\"; JSON needs the "
                "ASCII character \""},
        BadText{"{}\xEF\xBB\xBF{}", 1, 3,
                "a byte order mark is allowed only at the start; remove it"},
        BadText{"[\xEF]", 1, 2, "is not UTF-8 here; save the file as UTF-8"},
        BadText{"['a']", 1, 2, "JSON strings need double quotes"},
        BadText{"[NaN]", 1, 2, "\"NaN\" is not JSON; write a finite number"},
        BadText{"[-Infinity]", 1, 2, "\"-Infinity\" is not JSON; write a finite number"},
        BadText{"[+1]", 1, 2,
                "expected a value or ']', found \"+1\"; JSON numbers have no plus sign"},
        BadText{"[.5]", 1, 2,
                "expected a value or ']', found \".5\"; JSON numbers start with a digit"},
        BadText{"[1.]", 1, 2, "\"1.\" is not a JSON number: expected digit after '.'"},
        BadText{"[True]", 1, 2, "expected a value or ']', found \"True\"; JSON has true"},
        BadText{"[None]", 1, 2, "expected a value or ']', found \"None\"; JSON has null"},
        BadText{"[10 0]", 1, 5, "expected ',' or ']', found \"0\""},
        BadText{"[\xC2\xA0]", 1, 2, "expected a value or ']', found a no-break space (U+00A0)"},
        BadText{"{\xC2\xA0}", 1, 2,
                "expected a key in double quotes or '}', found a no-break space (U+00A0)"},
        BadText{"[\0]\0"sv, 1, 2, "is UTF-16, not UTF-8; save the file as UTF-8"},
        BadText{"\0[\0]"sv, 1, 1, "is UTF-16, not UTF-8; save the file as UTF-8"},
        BadText{"[nul]", 1, 2, "expected a value or ']', found \"nul\""},
        BadText{"[1e999]", 1, 2, "the number is out of range; the largest is about 1.8e308"},
        BadText{"[\n -1e999]", 2, 2, "the number is out of range; the largest is about 1.8e308"},
        BadText{"[\"abc", 1, 2, "the string that starts here is not closed"},
        BadText{"[\"abc\n\"]", 1, 2,
                "the string that starts here is not closed on its line; a line break within a "
                "string is written \\n"},
        BadText{"[\"a\tb\"]", 1, 4,
                "a control character within a string must be escaped, as in \\t or \\u0009"},
        BadText{"[\"a\0b\"]"sv, 1, 4,
                "a control character within a string must be escaped, as in \\t or \\u0009"},
        BadText{
            "[\"a\\x\"]", 1, 5,
            "unknown escape; a backslash must be followed by \" \\ / b f n r t or u and four hex "
            "digits"},
        BadText{"[\"\\u12\"]", 1, 7, "\\u must be followed by four hex digits"},
        BadText{"[\"\\ud800 \"]", 1, 9, "a \\u surrogate must be part of a pair, high then low"},
        BadText{"[\"\xC3(\"]", 1, 4, "is not UTF-8 here; save the file as UTF-8"},
        BadText{"[\"\xED\xA0\x80\"]", 1, 4, "is not UTF-8 here; save the file as UTF-8"},
        BadText{"\xFF\xFE{\0"sv, 1, 1, "is not UTF-8 here; save the file as UTF-8"},
        BadText{"{\"a\":1, \"b\":2,\n \"a\":3}", 2, 2, "the key \"a\" occurs twice in this object"},
        BadText{"\xEF\xBB\xBF[1 2]", 1, 4, "expected ',' or ']', found \"2\""}));

constexpr std::size_t kLong = 100'000;  // longer than what the parser is spared

TEST(JsonDocument, ReadsLongTokens) {
  const std::string plain(kLong, 'a');
  const auto repeated = [](std::string_view part) {
    std::string text;
    for (std::size_t i = 0; i < kLong; ++i) text += part;
    return text;
  };
  const std::array<std::pair<std::string, std::string>, 5> contents = {
      {{plain, plain},
       {plain + "\\n", plain + "\n"},
       {"\\\"" + plain, '"' + plain},
       {repeated("\xC3\xA9"), repeated("\xC3\xA9")},
       {repeated("\\\\"), std::string(kLong, '\\')}}};
  for (const auto& [written, meant] : contents) {
    const std::string white(kLong, '\n');
    const std::string text = white + "{\"" + written + "\"" + white + ":[\"" + written + "\"," +
                             white + "1" + std::string(200, '0') + white + "], \"\":\"\"}" + white;
    const JsonDocument document(text, "s.json");
    const std::vector<JsonMember>& members = document.root().members();
    ASSERT_EQ(members.size(), 2U);
    EXPECT_EQ(members[0].key, meant);
    EXPECT_EQ(members[0].value.items().at(0).string(), meant);
    EXPECT_EQ(members[0].value.items().at(1).number(), 1e200);
    EXPECT_EQ(text[members[0].value.items().at(1).offset], '1');
    EXPECT_EQ(members[1].key, "");
    EXPECT_EQ(members[1].value.string(), "");
  }
}

TEST(JsonDocument, RefusesLongTokensWithTheExactPlace) {
  const std::string plain(kLong, 'a'), white(kLong, '\n');
  const auto expect = [](const std::string& text, std::size_t line, std::size_t column,
                         std::string_view message) {
    const Diagnostic diagnostic = error_of(text).diagnostic();
    EXPECT_EQ(diagnostic.line, line);
    EXPECT_EQ(diagnostic.column, column);
    EXPECT_THAT(diagnostic.message, HasSubstr(message));
  };
  expect(white + "x", kLong + 1, 1, "expected a value");
  expect("[\"" + plain, 1, 2, "is not closed");
  expect("[\"" + plain + "\n  \"]", 1, 2, "is not closed on its line");
  expect("[\"" + plain + "\1  \"]", 1, kLong + 3, "control character");
  expect("[\"" + plain + "\\q  \"]", 1, kLong + 4, "unknown escape");
  expect("[\"" + plain + "\xFF  \"]", 1, kLong + 3, "is not UTF-8");
  expect("[\"" + plain + "\" \"b\"]", 1, kLong + 5, "found a string");
  expect("[" + std::string(kLong, '1') + "]", 1, 2, "out of range");
}

TEST(JsonDocument, NamesThePointerOfABadValue) {
  EXPECT_EQ(error_of(R"({"a":[0,{"b/c~":1e999}]})").diagnostic().pointer, "/a/1/b~1c~0");
  EXPECT_EQ(error_of(R"({"a":[0,{"b":1,"b":2}]})").diagnostic().pointer, "/a/1");
  EXPECT_EQ(error_of(R"([{"a":1},{"x":2,"x":3}])").diagnostic().pointer, "/1");
}

TEST(JsonDocument, RefusesDeepNestingAtItsPlace) {
  const std::string deep = std::string(255, '[') + "{\"a\":1}" + std::string(255, ']');
  EXPECT_NO_THROW(JsonDocument(deep, "s.json"));
  const Error error = error_of(std::string(256, '[') + "{");
  EXPECT_EQ(error.kind(), ErrorKind::limit);
  EXPECT_EQ(error.diagnostic().column, 257U);
  std::string objects;
  for (int i = 0; i < 10'000; ++i) objects += "{\"a\":";
  EXPECT_EQ(error_of(objects).kind(), ErrorKind::limit);
  EXPECT_EQ(error_of(std::string(100'000'000, '[')).kind(), ErrorKind::limit);
}

TEST(JsonDocument, RefusesMoreValuesThanItsLimit) {
  EXPECT_NO_THROW(JsonDocument("[1,{\"a\":[]}]", "s.json", 4));
  try {
    const JsonDocument document("[1,{\"a\":[]}]", "s.json", 3);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::limit);
    EXPECT_EQ(error.diagnostic().column, 9U);
    EXPECT_EQ(error.diagnostic().pointer, "/1/a");
  }
}

// Quadratic time would be minutes.
TEST(JsonDocument, FindsARepeatedKeyAmongMany) {
  std::string text = "{";
  for (int i = 0; i < 200'000; ++i) {
    text.append("\"k").append(std::to_string(i)).append("\":0,");
  }
  EXPECT_THAT(error_of(text + "\"k7\":1}").what(), HasSubstr("\"k7\" occurs twice"));
}

TEST(JsonDocument, FindsKeysAmongMany) {
  std::string text = "{";
  for (int i = 0; i < 1000; ++i) {
    text.append("\"k").append(std::to_string(i * 7919 % 1000)).append("\":");
    text.append(std::to_string(i)).append(",");
  }
  text += "\"\":-1}";
  const JsonDocument document(text, "s.json");
  for (int i = 0; i < 1000; ++i) {
    const JsonValue* found = document.root().find("k" + std::to_string(i * 7919 % 1000));
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->number(), i);
  }
  EXPECT_EQ(document.root().find("")->number(), -1);
  EXPECT_EQ(document.root().find("k"), nullptr);
  EXPECT_EQ(document.root().find("k1000"), nullptr);
  EXPECT_EQ(document.root().find("z"), nullptr);
}

TEST(JsonDocument, ReportsTheFirstDuplicateKey) {
  const std::string text =
      R"({"x": {"a": 0, "b": 1, "a": 2, "a": 3}, "y": 0, "z": {"c": 1, "c": 2}})";
  const JsonDocument inner(text, "s.json", kMaxJsonValues, RepeatedKeys::last_counts);
  EXPECT_EQ(inner.outdone_keys().count, 3U);
  EXPECT_EQ(inner.outdone_keys().pointer, "/x/a");
  EXPECT_EQ(inner.outdone_keys().offset, text.find("\"a\""));
  EXPECT_EQ(inner.root().find("x")->members().size(), 2U);
  EXPECT_EQ(inner.root().find("x")->find("a")->number(), 3);
  const JsonDocument outer(R"({"y": 1, "x": {"a": 0, "a": 1}, "y": 2})", "s.json", kMaxJsonValues,
                           RepeatedKeys::last_counts);
  EXPECT_EQ(outer.outdone_keys().count, 2U);
  EXPECT_EQ(outer.outdone_keys().pointer, "/y");
  const JsonDocument none(R"({"y": 1})", "s.json", kMaxJsonValues, RepeatedKeys::last_counts);
  EXPECT_EQ(none.outdone_keys().count, 0U);
}

TEST(JsonDocument, ShowsTheLineWithACaret) {
  EXPECT_STREQ(error_of("{\n\t\"a\":\t1 2\n}").what(),
               "s.json:2:9: expected ',' or '}', found \"2\"\n"
               " \"a\": 1 2\n"
               "        ^");
}

TEST(JsonDocument, EscapesPointersAsRfc6901Says) {
  EXPECT_EQ(child("", "a/b"), "/a~1b");
  EXPECT_EQ(child("/x", "m~n"), "/x/m~0n");
  EXPECT_EQ(child("/x", std::size_t{3}), "/x/3");
}

TEST(JsonDocument, ResolvesPointers) {
  JsonDocument document(R"({"a/b": [7, {"m~n": 8, "": 9}]})", "s.json");
  const auto number = [&](std::string_view pointer) {
    const JsonValue* value = resolve(document.root(), pointer);
    return value != nullptr ? value->number() : -1;
  };
  EXPECT_EQ(number("/a~1b/0"), 7);
  EXPECT_EQ(number("/a~1b/1/m~0n"), 8);
  EXPECT_EQ(number("/a~1b/1/"), 9);
  EXPECT_EQ(resolve(document.root(), ""), &document.root());
  for (const char* wrong : {"a", "/a", "/a~1b/2", "/a~1b/x", "/a~1b/0/x", "/a~1b/0x", "/a~2b"}) {
    EXPECT_EQ(number(wrong), -1) << wrong;
  }
}

/// Returns the JSON text after parsing and writing it.
std::string rewritten(std::string_view text, std::span<const std::string_view> left_out = {}) {
  const JsonDocument document(text, "s.json");
  std::string result;
  append_json(result, document.root(), left_out);
  return result;
}

TEST(JsonWriter, RoundTrips) {
  const std::string_view compact =
      R"({"a":[null,true,false,[],{}],"b":{"c":"\"\\/\u0001\u001fé"},"d":[7,-3,0.1,-12.5,1e+300]})";
  std::string expected(compact);
  for (const auto& [from, to] : {std::pair("0.1", "1e-01"), std::pair("-12.5", "-1.25e+01")}) {
    expected.replace(expected.find(from), std::string_view(from).size(), to);
  }
  EXPECT_EQ(rewritten(compact), expected);
  EXPECT_EQ(rewritten(expected), expected);
}

TEST(JsonWriter, KeepsTheBitsOfNumbers) {
  for (const char* text : {"0.1", "1e-320", "9007199254740993e3", "123456789012345678",
                           "0.30000000000000004", "1.7976931348623157e308"}) {
    const JsonDocument before(text, "s.json");
    const std::string again = rewritten(text);
    const JsonDocument after(again, "s.json");
    EXPECT_EQ(after.root().number(), before.root().number()) << text;
  }
  EXPECT_EQ(rewritten("[3.0, 5e2, 9007199254740992.0, -3, -0, -0.0]"),
            "[3,500,9007199254740992,-3,0,0]");
}

TEST(JsonWriter, LeavesOutMembersAtAnyDepth) {
  constexpr std::array<std::string_view, 2> kLeftOut = {"x", "y"};
  EXPECT_EQ(rewritten(R"({"x":1,"a":{"y":{},"b":[{"x":2}]},"y":3})", kLeftOut),
            R"({"a":{"b":[{}]}})");
}

}  // namespace
}  // namespace microtrace::io
