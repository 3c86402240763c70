#include "app/host/failure.h"

#include <fmt/format.h>

#include <new>
#include <system_error>

#include "app/host/errors.h"
#include "assets/model.h"
#include "render/context/context.h"
#include "scenes/loader/load_scene.h"
#include "sim/base/file.h"

namespace pneuma::app {

Failure failure_of(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const UsageError& usage) {
    return {ExitCode::usage, usage.what()};
  } catch (const scenes::SceneError& scene) {
    return {ExitCode::invalid_scene, scene.what(), true};
  } catch (const assets::ModelError& model) {
    return {ExitCode::invalid_scene, model.what(), true};
  } catch (const render::GlError& gl) {
    return {ExitCode::no_gl, gl.what()};
  } catch (const DivergenceError& divergence) {
    return {ExitCode::diverged, divergence.what()};
  } catch (const base::IoError& io) {
    return {ExitCode::input_output, io.what()};
  } catch (const std::system_error& system) {
    return {ExitCode::input_output, system.what()};
  } catch (const Interrupted& interrupted) {
    return {ExitCode::interrupted, interrupted.what()};
  } catch (const std::bad_alloc&) {
    return {ExitCode::input_output, "out of memory; make the scene or its pictures smaller"};
  } catch (const std::exception& mistake) {
    return {ExitCode::internal_error,
            fmt::format("a mistake in the program itself: {}", mistake.what())};
  }
}

}  // namespace pneuma::app
