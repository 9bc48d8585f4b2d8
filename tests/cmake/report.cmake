find_package(nlohmann_json REQUIRED)
glint_test(unit_report FOLDER unit/report LINKS glint::report nlohmann_json::nlohmann_json)
