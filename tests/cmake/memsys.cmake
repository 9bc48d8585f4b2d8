glint_test(unit_memsys WITH memsys FOLDER unit/memsys LINKS glint::memsys)
glint_test(timing_memsys WITH memsys FOLDER timing/memsys LINKS glint::memsys)
glint_test(property_memsys WITH memsys FOLDER property/memsys LINKS glint::memsys)
glint_test(contract_memsys WITH memsys FOLDER contract/memsys LINKS glint::memsys)
