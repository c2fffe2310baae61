hemi_test(golden_physics_twin_test
  SOURCES effects_test.cpp effects_signature_test.cpp effects_rate_test.cpp effects_faults_test.cpp
    thermal_network_test.cpp slow_twin_test.cpp slow_twin_noise_test.cpp slow_twin_resonator_test.cpp
  LIBRARIES hemi_physics Eigen3::Eigen Boost::headers)
