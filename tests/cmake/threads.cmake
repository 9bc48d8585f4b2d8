glint_test(threads LINKS glint::pipeline)
