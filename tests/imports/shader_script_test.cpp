#include "imports/maps/shader_script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "trace/error.h"

namespace regather::imports {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

TEST(ShaderScript, SurfaceLightSunImagesAndStagesAreRead) {
    const auto shaders = read_shader_scripts(R"(// a lamp
textures/x/Lamp
{
    qer_editorimage Textures/X/lamp.tga // comment
    SurfaceParm nomarks
    q3map_surfacelight 2000
    q3map_lightimage textures/x/glow.tga
    q3map_lightRGB 1 .5 0
    { map $lightmap
      rgbGen identity }
    {
        map textures/x/lamp.tga
        tcGen environment
        blendFunc GL_ONE GL_ONE
    }
}
/* textures/x/none { } */
textures/x/sky
{
    surfaceparm sky
    q3map_sun 1 0.9 0.8 200 305 70
}
textures/x/flame { { animMap 10 a.tga b.tga
 blendfunc add
 } }
)",
                                             "s");
    ASSERT_EQ(shaders.size(), 3u);
    EXPECT_EQ(shaders[0].name, "textures/x/Lamp");
    EXPECT_THAT(shaders[0].surface_parms, ElementsAre("nomarks"));
    EXPECT_EQ(shaders[0].surface_light, 2000);
    EXPECT_EQ(shaders[0].editor_image, "textures/x/lamp.tga");
    EXPECT_EQ(shaders[0].light_image, "textures/x/glow.tga");
    EXPECT_EQ(shaders[0].light_colour, (trace::Vec3{1, 0.5f, 0}));
    EXPECT_EQ(shaders[0].map, "textures/x/lamp.tga");
    EXPECT_TRUE(shaders[0].environment);
    EXPECT_FALSE(shaders[0].see_through);  // Only the first stage decides.
    EXPECT_TRUE(shaders[1].has_parm("sky"));
    EXPECT_EQ(shaders[1].sun_intensity, 200);
    EXPECT_EQ(shaders[1].sun_colour, (trace::Vec3{1, 0.9f, 0.8f}));
    EXPECT_EQ(shaders[2].map, "a.tga");
    EXPECT_TRUE(shaders[2].see_through);
}

TEST(ShaderScript, WhatIsNoNumberCountsAsZero) {
    for (const char* value : {"", "bright", "1e999", "nan"}) {
        const auto shaders =
            read_shader_scripts(std::string("a {\nq3map_surfacelight ") + value + "\n}", "s");
        EXPECT_EQ(shaders.at(0).surface_light, 0) << value;
    }
}

TEST(ShaderScript, DirectivesThatAreNotUsedAreCounted) {
    const auto shaders = read_shader_scripts(R"(a {
    surfaceparm NoMarks
    surfaceparm sky
    cull none
    deformVertexes wave 1
    deformVertexes wave 2
    sort additive
    { map a.tga
      tcMod scroll 1 1
      tcGen lightmap }
    { map b.tga
      tcGen environment
      tcmod rotate 3 }
})",
                                             "s");
    EXPECT_THAT(shaders.at(0).left_out,
                ElementsAre(Pair("cull", 1), Pair("deformvertexes", 2), Pair("sort", 1),
                            Pair("surfaceparm nomarks", 1), Pair("tcgen", 1), Pair("tcmod", 2)));
    std::string many = "a {\n";
    for (int i = 0; i < 300; ++i) many += "d" + std::to_string(i) + "\n";
    const auto bounded = read_shader_scripts(many + "}", "s");
    EXPECT_EQ(bounded.at(0).left_out.size(), 101u);
    EXPECT_EQ(bounded.at(0).left_out.at("other directives"), 200u);
}

TEST(ShaderScript, MissingAndSurplusBracesAreRefusedWithTheirLine) {
    const std::array<std::array<const char*, 2>, 6> cases{
        {{"a\n{", "s: line 2: found the end, expected }"},
         {"a\n{ }\n}", "s: line 3: found }"},
         {"{\n}", "s: line 1: found {"},
         {"a\nb\n{ }", "s: line 2: found \"b\", expected {"},
         {"a", "s: line 1: found the end, expected {"},
         {"a {\n{\n{", "s: line 3: found {"}}};
    for (const auto& [text, message] : cases) {
        try {
            read_shader_scripts(text, "s");
            ADD_FAILURE() << text;
        } catch (const trace::DataError& error) {
            EXPECT_THAT(error.what(), HasSubstr(message)) << text;
        }
    }
}

}  // namespace
}  // namespace regather::imports
