# Adds tests of the presets that reproduce a published simulator, against its arithmetic and its logs.
glint_test(timing_vulkan_sim WITH machine FOLDER timing/vulkan_sim LINKS glint::pipeline)
