#include "experiment/keys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "trace/error.h"

namespace regather::experiment {
namespace {

using nlohmann::json;
using testing::HasSubstr, testing::StartsWith;

constexpr std::array<std::string_view, 3> known{"width", "height", "name"};

std::string message(const std::function<void()>& read) {
    try {
        read();
    } catch (const trace::DataError& error) {
        return error.what();
    }
    return "accepted";
}

std::string message(const json& value, const std::function<void(const Object&)>& read,
                    const std::string& where = "capture") {
    const json parsed = json::parse(value.dump());  // as from a file, where 7 is unsigned
    return message([&] { read(Object(parsed, known, "x.json", where)); });
}

TEST(Keys, ValuesComeAsTheyStand) {
    const json value = json::parse(R"({"width": 7, "name": "hall", "height": [1, "2K"]})");
    const Object object(value, known, "x.json", "");
    EXPECT_EQ(object.number("width", 1, 0, 7), 7u);
    EXPECT_EQ(object.real("width", 1), 7.0);
    EXPECT_EQ(object.text("name"), "hall");
    EXPECT_EQ(object.list("height", {}), (std::vector<std::string>{"1", "2K"}));
    EXPECT_EQ(object.list("width", {}), (std::vector<std::string>{"7"}));
}

TEST(Keys, MissingOnesHaveTheirFallback) {
    const json value = json::object();
    const Object object(value, known, "x.json", "");
    EXPECT_FALSE(object.has("width"));
    EXPECT_EQ(object.number("width", 3, 5, 7), 3u);
    EXPECT_EQ(object.real("width", 2.5), 2.5);
    EXPECT_TRUE(object.flag("width", true));
    EXPECT_EQ(object.list("width", {"a"}), (std::vector<std::string>{"a"}));
    EXPECT_EQ(message(
                  value, [](const Object& o) { o.text("name"); }, ""),
              "x.json: name: found nothing, expected a text");
    EXPECT_EQ(message(value, [](const Object& o) { o.array("name"); }),
              "x.json: capture.name: found nothing, expected a list");
}

TEST(Keys, AnUnknownOneBringsTheNearest) {
    EXPECT_EQ(
        message({{"widht", 1}}, [](const Object&) {}),
        "x.json: capture.widht: found an unknown key, expected \"width\" (known keys: width, height, name)");
    EXPECT_THAT(message(
                    {{"Name", 1}}, [](const Object&) {}, ""),
                StartsWith("x.json: Name: found an unknown key, expected \"name\""));
}

TEST(Keys, NoObjectIsRefusedWithItsType) {
    EXPECT_EQ(message(json::array(), [](const Object&) {}),
              "x.json: capture: found array, expected an object");
    EXPECT_EQ(message(
                  json(7), [](const Object&) {}, ""),
              "x.json: the file: found number, expected an object");
}

TEST(Keys, NumbersOutOfRangeOrOfAnotherTypeAreRefused) {
    const auto number = [](const json& value) {
        return message({{"width", value}}, [](const Object& o) { o.number("width", 1, 2, 9); });
    };
    EXPECT_EQ(number(2), "accepted");
    EXPECT_EQ(number(9), "accepted");
    for (const json& value :
         {json(1), json(10), json(-3), json(2.0), json("3"), json(true), json(nullptr), json::array({3})})
        EXPECT_EQ(number(value),
                  "x.json: capture.width: found " + value.dump() + ", expected a whole number from 2 to 9");
}

TEST(Keys, RealsAreFiniteAndNotNegative) {
    const auto real = [](const json& value) {
        return message({{"width", value}}, [](const Object& o) { o.real("width", 1); });
    };
    EXPECT_EQ(real(0), "accepted");
    EXPECT_EQ(real(0.25), "accepted");
    for (const json& value : {json(-0.5), json(-1), json("1"), json(true), json(nullptr)})
        EXPECT_THAT(real(value), HasSubstr("expected a number that is not negative"));
}

TEST(Keys, FlagsTextsAndListsAreStrict) {
    const auto refused = [](const json& value, const std::function<void(const Object&)>& read) {
        return message({{"width", value}}, read);
    };
    EXPECT_THAT(refused(1, [](const Object& o) { o.flag("width", false); }),
                HasSubstr("found 1, expected true or false"));
    EXPECT_THAT(refused(1, [](const Object& o) { o.text("width"); }), HasSubstr("found 1, expected a text"));
    for (const json& value : {json(true), json(-1), json(1.5), json::object(), json{{1}}, json(nullptr)})
        EXPECT_THAT(refused(value, [](const Object& o) { o.list("width", {}); }),
                    HasSubstr("a text or a whole number"));
    EXPECT_THAT(refused(json::array(), [](const Object& o) { o.list("width", {}); }),
                HasSubstr("at least one value"));
    EXPECT_THAT(refused(json::array(), [](const Object& o) { o.array("width"); }),
                HasSubstr("at least one entry"));
    EXPECT_THAT(refused("a", [](const Object& o) { o.array("width"); }), HasSubstr("at least one entry"));
}

}  // namespace
}  // namespace regather::experiment
