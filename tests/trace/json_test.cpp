#include "trace/json.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "trace/error.h"

namespace regather::trace {
namespace {

std::string json_refusal(std::string_view text) {
    try {
        parse_json(text, "x.json");
    } catch (const DataError& error) {
        return error.what();
    }
    return "nothing was refused";
}

TEST(Json, ValuesOfEveryTypeAreExact) {
    const Json root =
        parse_json(R"({"n": null, "t": true, "u": 18446744073709551615, "s": -9223372036854775808,
        "d": 0.1, "big": 18446744073709551616, "text": "\u00e4\ud83c\udfe0\n\"", "list": [1, [], {}]})",
                   "x");
    EXPECT_TRUE(root.find("n")->is_null());
    EXPECT_TRUE(*root.find("t")->truth());
    EXPECT_EQ(*root.find("u")->whole(), std::numeric_limits<std::uint64_t>::max());
    EXPECT_EQ(*root.find("s")->negative(), std::numeric_limits<std::int64_t>::min());
    EXPECT_EQ(root.find("d")->number(), 0.1);
    EXPECT_EQ(root.find("big")->number(), 18446744073709551616.0);
    EXPECT_EQ(root.find("big")->whole(), nullptr);
    EXPECT_EQ(*root.find("text")->text(), "\xc3\xa4\xf0\x9f\x8f\xa0\n\"");
    EXPECT_EQ(root.find("list")->list()->size(), 3u);
    EXPECT_EQ(root.find("no"), nullptr);
    EXPECT_TRUE(std::isnan(root.find("text")->number()));
}

TEST(Json, MembersKeepTheOrderOfTheFile) {
    const Json root = parse_json(R"({"z": 1, "a": 2, "m": 3})", "x");
    std::string order;
    for (const Json::Member& member : *root.members()) order += member.key;
    EXPECT_EQ(order, "zam");
    EXPECT_EQ(root.dump(), R"({"z":1,"a":2,"m":3})");
}

TEST(Json, EachValueKnowsItsPlace) {
    const Json root = parse_json("{\n  \"a\": 17,\n  \"b\": [1.5,\n\t-2 , \"x\"]\n}", "x");
    const auto place = [](const Json& value) { return std::pair(value.line(), value.column()); };
    EXPECT_EQ(place(root), std::pair(1u, 1u));
    EXPECT_EQ(place(*root.find("a")), std::pair(2u, 8u));
    const Json& b = *root.find("b");
    EXPECT_EQ(place(b), std::pair(3u, 8u));
    EXPECT_EQ(place(b.list()->at(0)), std::pair(3u, 9u));
    EXPECT_EQ(place(b.list()->at(1)), std::pair(4u, 2u));
    EXPECT_EQ(place(b.list()->at(2)), std::pair(4u, 7u));
    EXPECT_EQ(place(parse_json(" 7", "x")), std::pair(1u, 2u));
}

TEST(Json, OtherSyntaxIsRefusedInOurWords) {
    const struct {
        std::string_view text, message;
    } cases[] = {
        {"", "line 1, column 1: found the end of the file, expected a value"},
        {" \n ", "line 2, column 2: found the end of the file, expected a value"},
        {"{} {}", "line 1, column 4: found '{', expected the end of the file"},
        {"{} 5", "line 1, column 4: found 5, expected the end of the file"},
        {"{\n  \"name\": \"t\",\n  \"camera\" 5\n}",
         "line 3, column 12: found 5, expected ':' after the key"},
        {"{\"a\"", "line 1, column 5: found the end of the file, expected ':' after the key"},
        {"{\"a\": ", "line 1, column 7: found the end of the file, expected a value"},
        {"{\"a\": }", "line 1, column 7: found '}', expected a value"},
        {"{\"a\": 1", "line 1, column 8: found the end of the file, expected ',' or '}'"},
        {"{\"a\": 1 \"b\": 2}", "line 1, column 9: found another text, expected ',' or '}'"},
        {"{\"a\": 1, }", "line 1, column 10: found '}', expected a key in double quotes"},
        {"{a: 1}", "line 1, column 2: found a, expected a key in double quotes or '}'"},
        {"{1: 1}", "line 1, column 2: found 1, expected a key in double quotes or '}'"},
        {"[", "line 1, column 2: found the end of the file, expected a value or ']'"},
        {"[1, 2", "line 1, column 6: found the end of the file, expected ',' or ']'"},
        {"[1,, 2]", "line 1, column 4: found ',', expected a value"},
        {"[1, 2,]", "line 1, column 7: found ']', expected a value"},
        {"[1 2]", "line 1, column 4: found 2, expected ',' or ']'"},
        {"[01]", "line 1, column 3: found 1, expected ',' or ']'"},
        {"[-01]", "line 1, column 4: found 1, expected ',' or ']'"},
        {"[0", "line 1, column 3: found the end of the file, expected ',' or ']'"},
        {"[NaN]", "line 1, column 2: found NaN, expected a value or ']'"},
        {"[-Infinity]",
         "line 1, column 2: found -Infinity, expected a number as JSON writes them, such as 1, -0.5 or 2e-7"},
        {"[1.]",
         "line 1, column 2: found 1., expected a number as JSON writes them, such as 1, -0.5 or 2e-7"},
        {"[+1]", "line 1, column 2: found +1, expected a value or ']'"},
        {"[True]", "line 1, column 2: found True, expected a value or ']'"},
        {"// no\n1", "line 1, column 1: found '/', expected a value"},
        {"[1e999]",
         "line 1, column 2: found 1e999, expected a number from -1.7976931348623157e+308 to "
         "1.7976931348623157e+308"},
        {"[\"a", "line 1, column 4: found the end of the file in a text, expected '\"'"},
        {"[\"a\n\"]", "line 1, column 4: found the end of the line in a text, expected '\"', or \\n"},
        {"[\"\x01\"]",
         "line 1, column 3: found the control character 0x01 in a text, expected it as \\u0001"},
        {"[\"a\xff\"]", "line 1, column 4: found the byte 0xff in a text, expected UTF-8"},
        {"[\"\xc3\"]", "line 1, column 3: found the byte 0xc3 in a text, expected UTF-8"},
        {"\xff\xfe[", "line 1, column 1: found '\\xff', expected a value"},
        {"[\"\\q\"]",
         "line 1, column 3: found \\q, expected one of \\\" \\\\ \\/ \\b \\f \\n \\r \\t, or \\u and four "
         "hexadecimal "
         "digits, surrogates in pairs"},
        {"{\"a\": 1,\n \"b\": {\"a\": 2}, \"a\": 3}",
         "line 2, column 17: found the key \"a\" a second time, expected each key once in an object"},
    };
    for (const auto& [text, message] : cases)
        EXPECT_EQ(json_refusal(text), "x.json: " + std::string(message)) << text;
    // \u0061 is an a.
    EXPECT_NE(json_refusal(R"({"a": 1, "\u0061": 2})").find("the key \"a\" a second time"),
              std::string::npos);
    for (const char* const text : {R"(["\ud800"])", R"(["\ud800\u0041"])", R"(["\udc00"])", R"(["\u12"])"})
        EXPECT_NE(json_refusal(text).find("surrogates in pairs"), std::string::npos) << json_refusal(text);
}

TEST(Json, AKeyIsFoundASecondTimeAmongManyToo) {
    std::string text = "{";
    for (int i = 0; i < 100; ++i) text += "\"k" + std::to_string(i) + "\": 1, ";
    EXPECT_EQ(parse_json(text + "\"last\": 1}", "x").members()->size(), 101u);
    for (const char* const again : {"k3", "k16", "k17", "k99"})
        EXPECT_NE(json_refusal(text + "\"" + again + "\": 1}").find("a second time"), std::string::npos)
            << again;
}

TEST(Json, DepthIsLimited) {
    const auto nested = [](std::size_t depth, std::string_view open, std::string_view inner,
                           std::string_view close) {
        std::string text;
        for (std::size_t i = 0; i < depth; ++i) text += open;
        text += inner;
        for (std::size_t i = 0; i < depth; ++i) text += close;
        return text;
    };
    EXPECT_EQ(parse_json(nested(64, "[", "", "]"), "x").list()->size(), 1u);
    const std::string too_deep = "found objects or lists 65 deep, expected at most 64";
    EXPECT_EQ(json_refusal(nested(65, "[", "", "]")), "x.json: line 1, column 65: " + too_deep);
    EXPECT_EQ(json_refusal(nested(65, "{\"a\":", "1", "}")), "x.json: line 1, column 321: " + too_deep);
    EXPECT_EQ(json_refusal(nested(1'000'000, "[", "", "]")), "x.json: line 1, column 65: " + too_deep);
    EXPECT_EQ(json_refusal(std::string(1'000'000, '[')), "x.json: line 1, column 65: " + too_deep);
}

TEST(Json, AByteOrderMarkIsPassedOver) {
    EXPECT_EQ(*parse_json("\xef\xbb\xbf[7]", "x").list()->at(0).whole(), 7u);
    EXPECT_EQ(json_refusal("\xef\xbb[7]"), "x.json: line 1, column 1: found '\\xef', expected a value");
}

TEST(Json, IsWrittenOverLinesOrOnOne) {
    const Json json = Json::object({{"a", 1},
                                    {"b", {std::vector<int>{1, -2}}},
                                    {"c", Json::object()},
                                    {"d", Json::List()},
                                    {"e", Json::object({{"f", nullptr}, {"g", "\x01\"\\\n\xc3\xa4\xff"}})}});
    EXPECT_EQ(json.dump(),
              "{\"a\":1,\"b\":[1,-2],\"c\":{},\"d\":[],"
              "\"e\":{\"f\":null,\"g\":\"\\u0001\\\"\\\\\\n\xc3\xa4\xef\xbf\xbd\"}}");
    EXPECT_EQ(json.dump(2),
              "{\n  \"a\": 1,\n  \"b\": [\n    1,\n    -2\n  ],\n  \"c\": {},\n  \"d\": [],\n"
              "  \"e\": {\n    \"f\": null,\n    \"g\": \"\\u0001\\\"\\\\\\n\xc3\xa4\xef\xbf\xbd\"\n  }\n}");
}

TEST(Json, DoublesAreWrittenByTheFewestDigits) {
    EXPECT_EQ(Json(0.1).dump(), "0.1");
    EXPECT_EQ(Json(2.0).dump(), "2.0");
    EXPECT_EQ(Json(-0.0).dump(), "-0.0");
    EXPECT_EQ(Json(1e-5).dump(), "1e-05");
    EXPECT_EQ(Json(5e-324).dump(), "5e-324");
    EXPECT_EQ(Json(0.3f).dump(), "0.30000001192092896");
    EXPECT_EQ(Json(std::numeric_limits<double>::infinity()).dump(), "null");
}

TEST(Json, IsEqualByValueWhateverTheOrderOfKeys) {
    const auto equal = [](std::string_view a, std::string_view b) {
        return parse_json(a, "a") == parse_json(b, "b");
    };
    EXPECT_TRUE(equal(R"({"a": 1, "b": [2.0, -3]})", R"({"b": [2, -3.0],   "a": 1})"));
    EXPECT_FALSE(equal(R"({"a": 1, "b": 2})", R"({"a": 2, "b": 1})"));
    EXPECT_FALSE(equal(R"({"a": 1})", R"({"a": 1, "b": 2})"));
    EXPECT_FALSE(equal("[1, 2]", "[2, 1]"));
    EXPECT_FALSE(equal("1", "true"));
    EXPECT_FALSE(equal("9007199254740993", "9007199254740992"));  // one double
    EXPECT_FALSE(equal("null", "0"));
}

rc::Gen<Json> any_json(int depth) {
    const auto text = rc::gen::map(rc::gen::container<std::string>(rc::gen::inRange<char>(0, 127)),
                                   [](std::string one) { return Json(std::move(one)); });
    const auto scalar = rc::gen::oneOf(
        rc::gen::just(Json()), rc::gen::map(rc::gen::arbitrary<bool>(), [](bool b) { return Json(b); }),
        rc::gen::map(rc::gen::arbitrary<std::uint64_t>(), [](std::uint64_t n) { return Json(n); }),
        rc::gen::map(rc::gen::arbitrary<std::int64_t>(), [](std::int64_t n) { return Json(n); }),
        rc::gen::map(rc::gen::arbitrary<double>(), [](double x) { return Json(std::isfinite(x) ? x : 0.5); }),
        text);
    if (depth == 0) return scalar;
    const auto list =
        rc::gen::map(rc::gen::container<std::vector<Json>>(any_json(depth - 1)), [](std::vector<Json> all) {
            all.resize(std::min<std::size_t>(all.size(), 5));
            return Json(Json::List(std::move(all)));
        });
    const auto object = rc::gen::map(list, [](const Json& values) {
        Json json = Json::object();
        for (const Json& one : *values.list())
            json["k" + std::to_string(json.members()->size()) + "\t\xc3\xa4"] = one;
        return json;
    });
    return rc::gen::oneOf(scalar, list, object);
}

RC_GTEST_PROP(Json, WhatIsWrittenIsReadBack, ()) {
    const Json json = *any_json(2);
    RC_ASSERT(parse_json(json.dump(), "x") == json);
    RC_ASSERT(parse_json(json.dump(2), "x") == json);
    RC_ASSERT(parse_json(json.dump(2), "x").dump() == json.dump());
}

RC_GTEST_PROP(Json, EveryPartOfAFileIsRefused, ()) {
    Json json = Json::object();
    json["a"] = *any_json(1);
    const std::string text = json.dump();
    const auto length = *rc::gen::inRange<std::size_t>(0, text.size());
    RC_ASSERT(json_refusal(text.substr(0, length)).starts_with("x.json: line 1, column "));
}

}  // namespace
}  // namespace regather::trace
