glint_test(unit_memsys FOLDER unit/memsys LINKS glint::memsys)
glint_test(timing_memsys ALONE FOLDER timing/memsys LINKS glint::memsys)
glint_test(property_memsys FOLDER property/memsys LINKS glint::memsys)
glint_test(contract_memsys FOLDER contract/memsys LINKS glint::memsys)
