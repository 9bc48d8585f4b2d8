# Adds the rules about the sources. Each rule is a test, so that a failure names it.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
set(lint ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/lint/lint.py)
foreach(rule layers layout includes sizes headers readmes doc_paths wording semantics)
  add_test(NAME lint_${rule} COMMAND ${lint} ${rule} ${PROJECT_SOURCE_DIR})
endforeach()
add_test(NAME lint_notices_violations
  COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/lint/lint_test.py)
if(TARGET glint)
  add_test(NAME lint_policies COMMAND ${lint} policies ${PROJECT_SOURCE_DIR} $<TARGET_FILE:glint>)
endif()
