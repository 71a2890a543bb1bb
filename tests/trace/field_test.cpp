#include "trace/field.h"

#include <gtest/gtest.h>

#include "trace/error.h"

namespace regather::trace {
namespace {

template <class Read>
std::string refusal(std::string_view text, const Read& read) {
    const Document document(text, "x.json", "scene");
    try {
        read(document.root());
    } catch (const DataError& error) {
        return error.what();
    }
    return "nothing was refused";
}

const Kind lamp{"lamp",
                {{"power", true, "a power [W]"}, {"name", false, "a text"}, {"at", false, "a point"}}};

TEST(Field, AnObjectIsReadByTheTableOfItsKeys) {
    const auto check = [](const Field& root) { root.check(lamp); };
    EXPECT_EQ(refusal(R"({"power": 1, "at": 0})", check), "nothing was refused");
    EXPECT_EQ(refusal("{\"power\": 1,\n\"nmae\": 0}", check),
              "x.json: line 2, nmae: found unknown key \"nmae\", expected \"name\" (keys of a lamp: power, "
              "name, at)");
    EXPECT_EQ(refusal("\n{}", check), "x.json: line 2, power: found nothing, expected a power [W]");
    EXPECT_EQ(refusal("[]", check), "x.json: line 1, scene: found an empty list, expected an object");
    EXPECT_EQ(refusal("{\"a\\nb\": 0}", check),
              "x.json: line 1, \"a\\nb\": found unknown key \"a\\nb\", expected \"at\" (keys of a lamp: "
              "power, name, at)");
    const Kind experiment{"experiment", {{"scene", true, "a scene"}}};
    EXPECT_EQ(refusal(R"({"scnee": 1})", [&](const Field& root) { root.check(experiment); }),
              "x.json: line 1, scnee: found unknown key \"scnee\", expected \"scene\" (keys of an "
              "experiment: scene)");
}

TEST(Field, KindsAreToldApartByAKey) {
    const Kind sun{"sun", {{"kind", true, "a kind"}, {"power", true, "a power"}}};
    const Kind bulb{"bulb", {{"kind", true, "a kind"}, {"size", false, "a size"}}};
    const std::vector<Kind> kinds{sun, bulb};
    std::string kind;
    const auto check = [&](const Field& root) { kind = root.check(kinds, "kind", "light").name; };
    EXPECT_EQ(refusal(R"({"kind": "bulb"})", check), "nothing was refused");
    EXPECT_EQ(kind, "bulb");
    EXPECT_EQ(refusal(R"({"kind": "bulp"})", check),
              "x.json: line 1, kind: found \"bulp\", expected \"bulb\" (lights: sun, bulb)");
    EXPECT_EQ(refusal(R"({"size": 1})", check),
              "x.json: line 1, kind: found nothing, expected \"sun\" or \"bulb\"");
    EXPECT_EQ(refusal(R"({"knid": 1})", check),
              "x.json: line 1, knid: found unknown key \"knid\", expected \"kind\" (keys of a light: kind, "
              "power, size)");
    EXPECT_EQ(refusal(R"({"kind": "sun"})", check), "x.json: line 1, power: found nothing, expected a power");
    EXPECT_EQ(refusal(R"({"size": 1})",
                      [&](const Field& root) { kind = root.check(kinds, "kind", "light", &lamp).name; }),
              "x.json: line 1, size: found unknown key \"size\", expected \"name\" (keys of a lamp light: "
              "power, name, at)");
}

TEST(Field, ValuesAreReadByTypeAndRange) {
    const auto whole = [](const Field& root) { root["n"].whole(2, 9); };
    for (const char* const good : {"2", "9", "4.0", "9e0"})
        EXPECT_EQ(refusal(std::string("{\"n\": ") + good + "}", whole), "nothing was refused") << good;
    for (const char* const bad :
         {"1", "10", "-3", "2.5", "1e300", "null", "[3]", "true", "18446744073709551618"})
        EXPECT_NE(
            refusal(std::string("{\"n\": ") + bad + "}", whole).find(", expected a whole number from 2 to 9"),
            std::string::npos)
            << bad;
    EXPECT_EQ(refusal("{\"n\": [[4], {\"a\": -1}]}",
                      [](const Field& root) { root["n"].elements()[1]["a"].number(0, 1, "a share"); }),
              "x.json: line 1, n[1].a: found -1, expected a share");
    const Document document("{\"u\": 18446744073709551615, \"h\": 0.5, \"w\": \"b\", \"p\": [1, 2.5, -3]}",
                            "x.json");
    const Field root = document.root();
    EXPECT_EQ(root["u"].whole<std::uint64_t>(0, ~std::uint64_t{0}), ~std::uint64_t{0});
    EXPECT_EQ(root["h"].number(0.5, 1, "", Field::Ends::closed), 0.5);
    EXPECT_THROW(root["h"].number(0.5, 1, "", Field::Ends::open_low), DataError);
    EXPECT_THROW(root["h"].number(0, 0.5, "", Field::Ends::open), DataError);
    EXPECT_EQ(root["h"].number(0, 0.5, "", Field::Ends::open_low), 0.5);
    const std::string_view words[] = {"a", "b"};
    EXPECT_EQ(root["w"].word(words), 1u);
    EXPECT_THROW(root["h"].word(words), DataError);
    EXPECT_EQ(root["p"].numbers(-3, 9, "three numbers"), (std::array<double, 3>{1, 2.5, -3}));
    EXPECT_THROW(root["p"].numbers(-2, 9, "three numbers"), DataError);
    EXPECT_FALSE(root.get("none"));
    EXPECT_THROW(root["none"], DataError);
}

}  // namespace
}  // namespace regather::trace
