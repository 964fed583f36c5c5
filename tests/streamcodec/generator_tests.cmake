# Tests of the generator in streamcodec/api/gen.
add_test(NAME generator COMMAND ${PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/generator/generator_test.py)
set_tests_properties(generator PROPERTIES LABELS unit ENVIRONMENT "MURAL_GL_XML=${GL_XML};PYTHONDONTWRITEBYTECODE=1")
