#pragma once
// Boost.Asio and Boost.Beast with separate compilation: their code is compiled in beast.cpp only.
// All files that use sockets include this header, so that all have the same macros.
#ifndef BOOST_ASIO_SEPARATE_COMPILATION
#define BOOST_ASIO_SEPARATE_COMPILATION
#endif
#ifndef BOOST_BEAST_SEPARATE_COMPILATION
#define BOOST_BEAST_SEPARATE_COMPILATION
#endif
// What sockets and timers run on is of one class, not of properties that each call asks for: a
// fifteenth of the time that their users take to compile.
#ifndef BOOST_ASIO_USE_TS_EXECUTOR_AS_DEFAULT
#define BOOST_ASIO_USE_TS_EXECUTOR_AS_DEFAULT
#endif
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/host_name.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
