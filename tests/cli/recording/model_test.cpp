// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/model.hpp"

#include "tests/cli/recording/scratch.hpp"

namespace hemi::recording::testing {
namespace {

using Model = ScratchTest;

constexpr const char* kFull = R"({
  "format": "hemi-model/1", "device": "HRG-1", "serial": {"lot": 7},
  "frequency": {"reference_degc": 0.5, "coefficients_hz": [4424.90095, 0.371555556, -9.70238095e-4], "source": "chamber"},
  "thermal": {"time_constant_s": 2600.0},
  "bias": {"reference_hz": 4432.07, "terms_dph": {"1": 2.0, "f": -0.31, "f^2": 0.004, "f^3": 0.5, "df": 850.0,
           "df^2": 1.5, "df^3": 2.5, "f*df": 3.5, "f^2*df": 4.5, "f*df^2": 5.5}},
  "scale_factor": 0.999,
  "drive": {"reference_degc": 20.0, "coefficients_v": [2.0, 0.004]},
  "quadrature": {"reference_degc": 21.0, "coefficients_v": [0.8]},
  "amplitude": {"setpoint": 1.1},
  "noise": {"rate_dph_rthz": 0.6, "frequency_hz_rthz": {"white": 2e-5, "random_walk": 1e-6, "differenced": 3e-6}},
  "effects": [{"id": "duffing", "parameters": {"b": 1e-7}}]
})";

TEST_F(Model, AllPartsAreRead) {
  const InstrumentModel model = read_model(file("m.json", kFull));
  EXPECT_EQ(model.device, "HRG-1");
  EXPECT_EQ(model.frequency->reference_degc, 0.5);
  EXPECT_EQ(model.frequency->coefficients_hz, (std::vector<double>{4424.90095, 0.371555556, -9.70238095e-4}));
  EXPECT_EQ(model.thermal_time_constant_s, 2600.0);
  EXPECT_EQ(model.bias->reference_hz, 4432.07);
  EXPECT_EQ(model.bias->terms_dph,
            (std::array<double, 10>{2.0, -0.31, 0.004, 0.5, 850.0, 1.5, 2.5, 3.5, 4.5, 5.5}));
  EXPECT_EQ(model.scale_factor, 0.999);
  EXPECT_EQ(model.drive->coefficients_v, (std::vector<double>{2.0, 0.004}));
  EXPECT_EQ(model.quadrature->reference_degc, 21.0);
  EXPECT_EQ(model.amplitude_setpoint, 1.1);
  EXPECT_EQ(model.noise.at("rate_dph_rthz").white, 0.6);
  EXPECT_EQ(model.noise.at("frequency_hz_rthz").differenced, 3e-6);
  EXPECT_EQ(model.effects[0]["id"], "duffing");
  EXPECT_FALSE(model.bench);
}

TEST_F(Model, RoundTripKeepsUnknownKeys) {
  const InstrumentModel model = read_model(file("m.json", kFull));
  write_model(path("n.json"), model);
  const InstrumentModel again = read_model(path("n.json"));
  EXPECT_EQ(to_json(again), to_json(model));
  EXPECT_EQ(again.document["serial"]["lot"], 7);
  EXPECT_EQ(again.document["frequency"]["source"], "chamber");
  Json expected = Json::parse(kFull);
  expected["noise"]["frequency_hz_rthz"]["flicker"] = 0.0;  // a part that was left out is zero
  EXPECT_TRUE(nlohmann::json(again.document) == nlohmann::json(expected));
  EXPECT_EQ(names(), (std::vector<std::string>{"m.json", "n.json"}));
}

TEST_F(Model, ChangesArriveInTheFile) {
  InstrumentModel model = read_model(file("m.json", kFull));
  model.frequency->coefficients_hz = {4425.0, 0.1};
  model.bias->terms_dph[4] = -1.0 / 3.0;
  model.noise["rate_dph_rthz"].flicker = 0.25;
  model.drive.reset();
  model.effects.push_back({{"id", "new"}});
  write_model(path("n.json"), model);
  const InstrumentModel again = read_model(path("n.json"));
  EXPECT_EQ(again.frequency->coefficients_hz, (std::vector<double>{4425.0, 0.1}));
  EXPECT_EQ(again.bias->terms_dph[4], -1.0 / 3.0);
  EXPECT_EQ(again.noise.at("rate_dph_rthz").flicker, 0.25);
  EXPECT_FALSE(again.drive);
  EXPECT_EQ(again.effects.size(), 2U);
}

TEST_F(Model, FromNothing) {
  InstrumentModel model;
  model.frequency = {0.0, {4425.0}};
  write_model(path("m.json"), model);
  EXPECT_EQ(read_model(path("m.json")).frequency->coefficients_hz, std::vector<double>{4425.0});
}

TEST_F(Model, Bench) {
  const InstrumentModel model = read_model(file(
      "m.json", R"({"format": "hemi-model/1", "bench": {"gain": 2, "damping_per_s": 3, "stiffness_per_s2": 4,
                         "constant_force": 5}})"));
  EXPECT_EQ(model.bench->stiffness_per_s2, 4.0);
  EXPECT_EQ(model.bench->constant_force, 5.0);
  EXPECT_FALSE(model.frequency);
  EXPECT_EQ(to_json(model), model.document);
}

TEST_F(Model, BadFiles) {
  const auto bad = [&](const char* text, std::initializer_list<std::string_view> parts) {
    const std::string json = file("m.json", text);
    expect_input_error([&] { read_model(json); }, {json});
    expect_input_error([&] { read_model(json); }, parts);
  };
  const auto with = [](const std::string& rest) { return "{\"format\": \"hemi-model/1\", " + rest + "}"; };
  bad("", {"is empty"});
  bad("{\n\"format\": \"hemi-model/1\",\n\"device\" 3}", {"m.json:3", "not valid JSON"});
  bad("{}", {"format", "is missing", "hemi-model/1"});
  bad(R"({"format": "hemi-recording/1"})", {"format", "no instrument model"});
  bad(with(R"("device": 5)").c_str(), {"device", "expected text"});
  bad(with(R"("frequency": 5)").c_str(), {"frequency", "expected an object"});
  bad(with(R"("frequency": {"reference_degc": 0})").c_str(),
      {"frequency.coefficients_hz", "list of numbers"});
  bad(with(R"("frequency": {"reference_degc": 0, "coefficients_hz": []})").c_str(),
      {"frequency.coefficients_hz"});
  bad(with(R"("frequency": {"reference_degc": 0, "coefficients_hz": [1, "x"]})").c_str(),
      {"frequency.coefficients_hz", "list of numbers"});
  bad(with(R"("frequency": {"coefficients_hz": [1]})").c_str(), {"frequency.reference_degc", "is missing"});
  bad(with(R"("thermal": {"time_constant_s": -1})").c_str(), {"thermal.time_constant_s", "below zero"});
  bad(with(R"("thermal": {"time_constant_s": "long"})").c_str(),
      {"thermal.time_constant_s", "expected a number"});
  bad(with(R"("bias": {"reference_hz": 1, "terms_dph": {"f2": 1}})").c_str(),
      {"bias.terms_dph.f2", "no such term", "f^2*df"});
  bad(with(R"("bias": {"reference_hz": 1})").c_str(), {"bias.terms_dph", "is missing"});
  bad(with(R"("bias": {"reference_hz": 1, "terms_dph": {"f": true}})").c_str(),
      {"bias.terms_dph.f", "expected a number"});
  bad(with(R"("scale_factor": 0)").c_str(), {"scale_factor", "zero"});
  bad(with(R"("amplitude": {"setpoint": 0})").c_str(), {"amplitude.setpoint"});
  bad(with(R"("noise": {"rate_dph_rthz": -1})").c_str(), {"noise.rate_dph_rthz", "below zero"});
  bad(with(R"("noise": {"rate_dph_rthz": {"white": "x"}})").c_str(), {"noise.rate_dph_rthz.white"});
  bad(with(R"("effects": {})").c_str(), {"effects", "expected a list"});
  bad(with(R"("bench": {"gain": 1})").c_str(), {"bench.damping_per_s", "is missing"});
  bad(with(R"("scale_factor": 1e999)").c_str(), {"too large"});
  expect_input_error([&] { read_model(path("none.json")); }, {"none.json", "No such file"});
}

}  // namespace
}  // namespace hemi::recording::testing
