// Distributed objects: everything that a program needs to share state between the processes of a session.
#pragma once

#include <mural/archive.hpp>
#include <mural/barrier.hpp>
#include <mural/blob.hpp>
#include <mural/object_reader.hpp>
#include <mural/queue.hpp>
#include <mural/ref.hpp>
#include <mural/shared.hpp>
#include <mural/sharing.hpp>
