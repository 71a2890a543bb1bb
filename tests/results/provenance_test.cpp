#include "results/provenance.h"

#include <gtest/gtest.h>

#include "tests/results/folder.h"
#include "trace/file.h"

namespace regather::results {
namespace {

TEST(Provenance, StandsBesideItsCsvAndHoldsWhatMadeIt) {
    const Folder folder;
    const Provenance provenance{
        {"/somewhere/bin/regather", "run", "a \"b\".json"}, "0.1.0", "abc123", "0011ff"};
    write_provenance(folder / "rows.csv", provenance, trace::Json::object({{"k", 100}, {"width", 512}}));
    EXPECT_EQ(trace::read_file(folder / "rows.json"), R"({
  "results": "rows.csv",
  "command_line": [
    "regather",
    "run",
    "a \"b\".json"
  ],
  "regather_version": "0.1.0",
  "git_revision": "abc123",
  "trace_checksum": "0011ff",
  "trace_parameters": {
    "k": 100,
    "width": 512
  }
}
)");
    EXPECT_FALSE(std::filesystem::exists(folder / "rows.json.part"));
}

TEST(Provenance, ArgumentsThatAreNoUtf8DoNotLoseTheRun) {
    const Folder folder;
    write_provenance(folder / "rows.csv", {{"regather", "\xFF"}, "", "", ""}, nullptr);
    const trace::Json read = trace::parse_json(trace::read_file(folder / "rows.json"), "rows.json");
    EXPECT_EQ(*read.find("command_line")->list()->at(1).text(), "\uFFFD");
    EXPECT_TRUE(read.find("trace_parameters")->is_null());
}

}  // namespace
}  // namespace regather::results
