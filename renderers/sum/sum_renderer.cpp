#include "renderers/sum/sum_renderer.h"

#include <algorithm>
#include <cassert>
#include <memory>

namespace renderers::sum {

namespace {

using Values = std::vector<std::pair<std::string, base::ParameterValue>>;

const base::ParameterValue* fixed_value(const Part& part, const std::string& name) {
  const auto found =
      std::ranges::find(part.fixed, name, [](const auto& entry) { return entry.first; });
  return found == part.fixed.end() ? nullptr : &found->second;
}

std::string named(const Part& part, const std::string& name) { return part.name + "_" + name; }

/// A part's own parameters among those of the sum.
base::Parameters parameters_of(const Part& part, const base::Parameters& all) {
  Values values;
  for (const base::ParameterSpec& spec : part.info.parameters) {
    if (const base::ParameterValue* fixed = fixed_value(part, spec.name)) {
      values.emplace_back(spec.name, *fixed);
      continue;
    }
    const std::string name = named(part, spec.name);
    const auto found =
        std::ranges::find(all.entries(), name, [](const auto& entry) { return entry.first; });
    assert(found != all.entries().end());
    values.emplace_back(spec.name, found->second);
  }
  return base::Parameters(std::move(values));
}

double rays_of(const Frame& frame) {
  for (const auto& [name, value] : frame.counters) {
    if (name == "rays" && std::holds_alternative<double>(value)) return std::get<double>(value);
  }
  return 0.0;
}

class SumRenderer final : public Renderer {
 public:
  SumRenderer(const std::vector<Part>& parts, const base::Parameters& parameters,
              const Devices& devices)
      : parts_(parts) {
    for (const Part& part : parts_) {
      renderers_.push_back(part.info.create(parameters_of(part, parameters), devices));
    }
  }

  void prepare(const scene::Scene& scene, StageTimer& timer) override {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const auto stage = timer.stage(parts_[i].stage);
      renderers_[i]->prepare(scene, timer);
    }
  }
  void update(const scene::Scene& scene, StageTimer& timer) override {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const auto stage = timer.stage(parts_[i].stage);
      renderers_[i]->update(scene, timer);
    }
  }
  Frame render(const RenderJob& job, StageTimer& timer) override;

 private:
  static void append(const Part& part, Frame of_part, Frame& frame);

  std::vector<Part> parts_;
  std::vector<std::unique_ptr<Renderer>> renderers_;
};

Frame SumRenderer::render(const RenderJob& job, StageTimer& timer) {
  RenderJob part_job = job;
  part_job.checkpoint = nullptr;
  Frame frame;
  double rays = 0.0;
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const auto stage = timer.stage(parts_[i].stage);
    frames.push_back(renderers_[i]->render(part_job, timer));
    rays += rays_of(frames.back());
  }
  const auto stage = timer.stage("readback");
  frame.radiance = frames[0].radiance;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    for (std::size_t k = 0; k < frame.radiance.pixels.size(); ++k) {
      frame.radiance.pixels[k] += frames[i].radiance.pixels[k];
    }
  }
  frame.counters.emplace_back("rays", rays);
  for (std::size_t i = 0; i < parts_.size(); ++i) append(parts_[i], std::move(frames[i]), frame);
  return frame;
}

/// Takes a part's pictures and numbers into the whole frame.
void SumRenderer::append(const Part& part, Frame of_part, Frame& frame) {
  frame.aovs.push_back({part.name, std::move(of_part.radiance)});
  for (perception::NamedImage& image : of_part.aovs) {
    frame.aovs.push_back({named(part, image.name), std::move(image.image)});
  }
  for (auto& [name, value] : of_part.counters) {
    frame.counters.emplace_back(named(part, name), std::move(value));
  }
  for (const std::string& note : of_part.notes) frame.notes.push_back(part.name + ": " + note);
  if (of_part.device == "cpu") return;
  frame.device = of_part.device;
  frame.gl_platform = of_part.gl_platform;
}

std::vector<base::ParameterSpec> parameter_specs(const std::vector<Part>& parts) {
  std::vector<base::ParameterSpec> specs;
  for (const Part& part : parts) {
    for (base::ParameterSpec spec : part.info.parameters) {
      if (fixed_value(part, spec.name) != nullptr) continue;
      spec.name = named(part, spec.name);
      spec.doc = "Of " + part.info.name + ": " + spec.doc;
      specs.push_back(std::move(spec));
    }
  }
  return specs;
}

std::vector<base::Preset> presets_of(const std::vector<Part>& parts) {
  std::vector<base::Preset> presets;
  for (const base::Preset& first : parts[0].info.presets) {
    base::Preset preset{first.name, {}};
    for (const Part& part : parts) {
      const auto found = std::ranges::find(part.info.presets, first.name, &base::Preset::name);
      if (found == part.info.presets.end()) continue;
      for (const auto& [name, value] : found->values) {
        if (fixed_value(part, name) == nullptr)
          preset.values.emplace_back(named(part, name), value);
      }
    }
    presets.push_back(std::move(preset));
  }
  return presets;
}

std::vector<Feature> features_of_all(const std::vector<Part>& parts) {
  std::vector<Feature> features = parts[0].info.supports;
  for (const Part& part : parts) {
    std::erase_if(features, [&](Feature feature) {
      return std::ranges::find(part.info.supports, feature) == part.info.supports.end();
    });
  }
  return features;
}

}  // namespace

RendererInfo renderer_info(const Description& description, std::vector<Part> parts,
                           Claims (*claims)(const base::Parameters&, const scene::Scene&)) {
  assert(!parts.empty());
  RendererInfo info;
  info.name = description.name;
  info.summary = description.summary;
  info.source = description.source;
  info.claims = claims;
  info.possible_claims = {description.claims};
  info.supports = features_of_all(parts);
  info.parameters = parameter_specs(parts);
  info.presets = presets_of(parts);
  for (const Part& part : parts) {
    assert(!part.info.progressive_unit);
    info.uses_seed = info.uses_seed || part.info.uses_seed;
    info.history = info.history || part.info.history;
  }
  info.create = [parts = std::move(parts)](const base::Parameters& parameters,
                                           const Devices& devices) {
    return std::make_unique<SumRenderer>(parts, parameters, devices);
  };
  return info;
}

}  // namespace renderers::sum
