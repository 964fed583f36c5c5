"""Sends clicks to a window, and waits until a pixel of the display changes. Uses libX11, which every display has."""

import ctypes
import time

ALL_PLANES = ctypes.c_ulong(-1).value
Z_PIXMAP = 2
BUTTON_PRESS = 4
BUTTON_PRESS_MASK = 1 << 2


class XButtonEvent(ctypes.Structure):
    """XButtonEvent of X11/Xlib.h."""

    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int), ("display", ctypes.c_void_p),
                ("window", ctypes.c_ulong), ("root", ctypes.c_ulong), ("subwindow", ctypes.c_ulong), ("time", ctypes.c_ulong),
                ("x", ctypes.c_int), ("y", ctypes.c_int), ("x_root", ctypes.c_int), ("y_root", ctypes.c_int), ("state", ctypes.c_uint),
                ("button", ctypes.c_uint), ("same_screen", ctypes.c_int), ("rest", ctypes.c_long * 12)]  # XEvent is 24 longs


def _library():
    xlib = ctypes.CDLL("libX11.so.6")
    xlib.XOpenDisplay.restype = ctypes.c_void_p
    xlib.XDefaultRootWindow.restype = ctypes.c_ulong
    xlib.XDefaultRootWindow.argtypes = [ctypes.c_void_p]
    xlib.XGetImage.restype = ctypes.c_void_p
    xlib.XGetImage.argtypes = [ctypes.c_void_p, ctypes.c_ulong, ctypes.c_int, ctypes.c_int, ctypes.c_uint, ctypes.c_uint, ctypes.c_ulong, ctypes.c_int]
    xlib.XGetPixel.restype = ctypes.c_ulong
    xlib.XGetPixel.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_int]
    xlib.XDestroyImage.argtypes = [ctypes.c_void_p]
    xlib.XSendEvent.argtypes = [ctypes.c_void_p, ctypes.c_ulong, ctypes.c_int, ctypes.c_long, ctypes.c_void_p]
    xlib.XFlush.argtypes = [ctypes.c_void_p]
    xlib.XCloseDisplay.argtypes = [ctypes.c_void_p]
    return xlib


class Clicks:
    """A connection to the display. window: receives the clicks; x, y: of the pixel, on the root window, topmost window."""

    def __init__(self, display, window, x, y):
        self.xlib = _library()
        self.display = self.xlib.XOpenDisplay(display.encode())
        if not self.display:
            raise RuntimeError("the display %s cannot be opened" % display)
        self.root = self.xlib.XDefaultRootWindow(self.display)
        self.window, self.x, self.y = window, x, y

    def pixel(self):
        image = self.xlib.XGetImage(self.display, self.root, self.x, self.y, 1, 1, ALL_PLANES, Z_PIXMAP)
        value = self.xlib.XGetPixel(image, 0, 0)
        self.xlib.XDestroyImage(image)
        return value & 0xffffff

    def seconds_to_change(self, limit=10.0):
        """Clicks, and returns the time until the pixel changes; None: not within the limit."""
        before = self.pixel()
        event = XButtonEvent(type=BUTTON_PRESS, display=self.display, window=self.window, root=self.root, x=5, y=5, button=1, same_screen=1)
        began = time.perf_counter()
        self.xlib.XSendEvent(self.display, self.window, 0, BUTTON_PRESS_MASK, ctypes.byref(event))
        self.xlib.XFlush(self.display)
        while time.perf_counter() < began + limit:
            if self.pixel() != before:
                return time.perf_counter() - began
            time.sleep(0.0002)  # a loop without a pause would take a core
        return None

    def close(self):
        self.xlib.XCloseDisplay(self.display)
