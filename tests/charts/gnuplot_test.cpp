#include "charts/gnuplot.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/results/folder.h"

namespace regather::charts {
namespace {

using namespace results;

std::string failure(std::string_view script) {
    try {
        run_gnuplot(script);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

TEST(Gnuplot, GivesWhatTheScriptLeavesOnStdout) {
    EXPECT_EQ(run_gnuplot("set print '-'\nprint 6 * 7\n"), "42\n");
}

TEST(Gnuplot, SaysInOneLineWhatIsWrongWithAScript) {
    const std::string text = failure("set terminal svg\nplot 'no such file'\n");
    EXPECT_NE(text.find("gnuplot: exit code 1: "), std::string::npos) << text;
    EXPECT_NE(text.find("No data in plot"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

TEST(Gnuplot, IsAskedForByNameWhenMissing) {
    const Folder empty;
    const std::string path = std::getenv("PATH");
    setenv("PATH", empty.path().c_str(), 1);
    const std::string text = failure("print 1\n");
    setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(text, "gnuplot: not found in PATH; charts need the Debian package gnuplot-nox");
}

TEST(Gnuplot, AStringShowsItselfWhateverItHolds) {
    for (const std::string text : {"`id`", "$HOME @x {/Bold a} \\n \"q\"", "%d %s", "", "a\\"})
        EXPECT_EQ(run_gnuplot("set print '-'\nprint " + gnuplot_string(text) + "\n"), text + "\n");
    EXPECT_EQ(run_gnuplot("set print '-'\nprint " + gnuplot_string("''it's'") + "\n"), "’’it’s’\n");
    EXPECT_EQ(gnuplot_string("a\nexit\r\tb"), "'a exit  b'");
    EXPECT_EQ(gnuplot_string("a\x1b[31m\xff\xc3\xa9\xef\xbf\xbf\x7f"),
              "'a [31m\xef\xbf\xbd\xc3\xa9\xef\xbf\xbd '");
}

}  // namespace
}  // namespace regather::charts
