# The paper's experiment: placing, samples, fit.
set(sim ${PROJECT_SOURCE_DIR}/src/sim)
vox_test(fit internal/test_fit.cpp ${sim}/fit.cpp LIBS vox::vox)
target_include_directories(test_fit PRIVATE ${sim})
vox_test(experiment_fit sim/test_experiment_fit.c LIBS vox::sim m)
if(VOX_BUILD_IO)
  vox_test(experiment sim/test_experiment.c LIBS vox::sim vox::io m)
  set_tests_properties(experiment PROPERTIES LABELS heavy)
endif()
