// Moments of depths on the device: the levels, and the atoms that are read from them.
#include "renderers/clustered_visibility/moment_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "renderers/clustered_visibility/shader_files.h"
#include "renderers/opengl/program.h"
#include "tests/renderers/clustered_visibility/depth_bench.h"
#include "tests/renderers/clustered_visibility/moment_oracle.h"
#include "tests/renderers/many_lights/gl_fixture.h"

namespace test_clustered_visibility {
namespace {

namespace opengl = renderers::opengl;

constexpr const char* kAtomsPath = "atoms.comp.glsl";
constexpr const char* kAtomsText = R"(
#include "renderers/clustered_visibility/shaders/moment_atoms.glsl"
layout(local_size_x = 64) in;
struct Query { vec4 moments; vec4 depth; };
struct Answer { vec4 atoms; vec4 own; };
layout(std430, binding = 3) readonly buffer Queries { Query queries[]; };
layout(std430, binding = 4) writeonly buffer Answers { Answer answers[]; };
uniform int query_count;
void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= query_count) return;
  Atoms atoms = atoms_of(queries[i].moments, queries[i].depth.x, 0.0);
  answers[i] = Answer(vec4(atoms.depth, atoms.mass), vec4(atoms.own_mass, 0.0, 0.0, 0.0));
}
)";

struct Query {
  glm::vec4 moments{0.0F};
  glm::vec4 depth{0.0F};
};
struct Answer {
  glm::vec4 atoms{0.0F};
  glm::vec4 own{0.0F};
};

class MomentMapsTest : public renderers::test::GlTest {
 protected:
  std::vector<Answer> answers(const std::vector<Query>& queries) const {
    const auto kit = cv::shader_files();
    std::vector<opengl::ShaderFile> files(kit.begin(), kit.end());
    files.push_back({kAtomsPath, kAtomsText});
    opengl::Program program(*context(), {files, {kAtomsPath}, {}});
    const auto buffer = opengl::Buffer::of(context(), std::span<const Query>(queries));
    const opengl::Buffer result(context(), queries.size() * sizeof(Answer));
    program.storage(3, buffer);
    program.storage(4, result);
    program.set("query_count", static_cast<int>(queries.size()));
    program.dispatch(opengl::groups_for(static_cast<std::int64_t>(queries.size()), 64));
    return result.read<Answer>(queries.size());
  }
};

TEST_F(MomentMapsTest, LevelsAreMeansOfPowers) {
  const DepthLayers layers = blocks_on_slopes(32, 2);
  const DepthBench bench(context(), layers);
  const cv::MomentMaps maps = bench.moment_maps();
  EXPECT_EQ(maps.moments().shape().levels, 6);
  for (int layer = 0; layer < 2; ++layer) {
    const DepthMap map = depths_of(layers, layer);
    for (int level = 0; level < 6; ++level) {
      const int side = 32 >> level;
      std::vector<double> expected(static_cast<std::size_t>(4 * side * side), 0.0);
      for (int i = 0; i < 32 * 32; ++i) {
        const auto texel = static_cast<std::size_t>((i / 32 >> level) * side + (i % 32 >> level));
        double power = 1.0;
        for (std::size_t n = 0; n < 4; ++n) {
          power *= 2.0 * map.z[static_cast<std::size_t>(i)] - 1.0;
          expected[4 * texel + n] += std::ldexp(power, -2 * level);
        }
      }
      const auto values = maps.moments().read(level, layer);
      ASSERT_EQ(values.size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_NEAR(static_cast<double>(values[i]), expected[i], 1e-6) << level << " " << i;
      }
    }
  }
}

TEST_F(MomentMapsTest, AtomsAreTheOracles) {
  const DepthMap map = depths_of(blocks_on_slopes(32, 1), 0);
  std::vector<Query> queries;
  std::vector<MomentAtoms> expected;
  for (int i = 0; i < 60; ++i) {
    const glm::dvec2 center(0.1 + 0.013 * i, 0.9 - 0.012 * i);
    const Moments moments = moments_of(box_kernel(map, center, 0.4));
    for (const double z : {-0.9, -0.35, 0.12, 0.6}) {
      queries.push_back({glm::vec4(glm::dvec4(moments[1], moments[2], moments[3], moments[4])),
                         glm::vec4(static_cast<float>(z))});
      expected.push_back(atoms_of(moments, static_cast<double>(static_cast<float>(z))));
    }
  }
  const std::vector<Answer> answers = this->answers(queries);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const MomentAtoms& atoms = expected[i];
    EXPECT_NEAR(static_cast<double>(answers[i].atoms.x), atoms.depth[0], 1e-3) << i;
    EXPECT_NEAR(static_cast<double>(answers[i].atoms.y), atoms.depth[1], 1e-3) << i;
    EXPECT_NEAR(static_cast<double>(answers[i].atoms.z), atoms.mass[0], 1e-3) << i;
    EXPECT_NEAR(static_cast<double>(answers[i].atoms.w), atoms.mass[1], 1e-3) << i;
    EXPECT_NEAR(static_cast<double>(answers[i].own.x), atoms.mass[2], 1e-3) << i;
  }
}

}  // namespace
}  // namespace test_clustered_visibility
