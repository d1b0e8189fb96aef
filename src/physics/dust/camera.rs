//! Where an eye stands, and the ray of each point of its picture.

use glam::DVec3;

/// A ray: from a point along a direction of length 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where it begins.
    pub origin: DVec3,
    /// Where it goes, away from the eye.
    pub direction: DVec3,
}

/// How directions are laid on the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lens {
    /// Parallel rays; the picture is this wide, in the volume's unit of length.
    Orthographic {
        /// Width of the picture.
        width: f64,
    },
    /// A pinhole; the full horizontal angle in radians, below pi.
    Perspective {
        /// Full horizontal angle.
        field: f64,
    },
    /// Equidistant fisheye in the largest circle that the picture holds, black outside; the full angle across that circle in radians, to 2 pi.
    /// Its centre is where the camera looks.
    Domemaster {
        /// Full angle.
        field: f64,
    },
}

/// An eye. f64, because voxels are found by differences of places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    eye: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    lens: Lens,
    /// Of a perspective, the tangent of half its field.
    tangent: f64,
}

impl Camera {
    /// An eye at a place that looks to another, with "up" as near to a direction as can be; nothing where these give no direction.
    ///
    /// When it looks along "up", another axis stands in, so that looking straight down is no special case for the caller.
    #[must_use]
    pub fn looking(eye: DVec3, at: DVec3, up: DVec3, lens: Lens) -> Option<Camera> {
        let forward = (at - eye).try_normalize()?;
        let right = forward.cross(up).try_normalize().filter(|r| r.is_finite());
        let right = match right {
            Some(right) if forward.cross(up).length() > 1e-9 * up.length() => right,
            _ => forward.any_orthonormal_vector(),
        };
        let sound = match lens {
            Lens::Orthographic { width } => width.is_finite() && width > 0.0,
            Lens::Perspective { field } => field > 0.0 && field < std::f64::consts::PI,
            Lens::Domemaster { field } => field > 0.0 && field <= std::f64::consts::TAU,
        };
        let tangent = if let Lens::Perspective { field } = lens { (field / 2.0).tan() } else { 0.0 };
        sound.then(|| Camera { eye, forward, right, up: right.cross(forward), lens, tangent })
    }

    /// Where it stands.
    #[must_use]
    pub fn eye(&self) -> DVec3 {
        self.eye
    }

    /// The direction that all its rays have, if they have one: it is orthographic.
    #[must_use]
    pub fn parallel(&self) -> Option<DVec3> {
        matches!(self.lens, Lens::Orthographic { .. }).then_some(self.forward)
    }

    /// The ray of a point of a picture of width x height pixels: x from 0 at its left edge to width, y from 0 at its top to height.
    /// Nothing outside a domemaster's circle. Pixels are square.
    #[must_use]
    pub fn ray(&self, x: f64, y: f64, width: usize, height: usize) -> Option<Ray> {
        let (w, h) = (width as f64, height as f64);
        // From the centre, right and up, in half widths.
        let (right, up) = ((2.0 * x - w) / w, (h - 2.0 * y) / w);
        match self.lens {
            Lens::Orthographic { width } => {
                let across = (self.right * right + self.up * up) * (width / 2.0);
                Some(Ray { origin: self.eye + across, direction: self.forward })
            }
            Lens::Perspective { .. } => {
                let across = (self.right * right + self.up * up) * self.tangent;
                Some(Ray { origin: self.eye, direction: (self.forward + across).normalize() })
            }
            Lens::Domemaster { field } => {
                let scale = w / w.min(h);
                let radius = right.hypot(up) * scale;
                if radius > 1.0 {
                    return None;
                }
                let (sine, cosine) = (radius * field / 2.0).sin_cos();
                let across = (self.right * right + self.up * up).normalize_or_zero();
                Some(Ray { origin: self.eye, direction: self.forward * cosine + across * sine })
            }
        }
    }
}

impl Camera {
    /// Where a point is drawn: x and y as [`Camera::ray`] takes them, also beside the picture; nothing behind the eye or outside the circle.
    #[must_use]
    pub fn place(&self, point: DVec3, width: usize, height: usize) -> Option<(f64, f64)> {
        let (w, h) = (width as f64, height as f64);
        let way = point - self.eye;
        let (right, up, ahead) = (way.dot(self.right), way.dot(self.up), way.dot(self.forward));
        let (right, up) = match self.lens {
            Lens::Orthographic { width } => (right * 2.0 / width, up * 2.0 / width),
            Lens::Perspective { field } => {
                let scale = ahead * (field / 2.0).tan();
                (ahead > 0.0).then_some((right / scale, up / scale))?
            }
            Lens::Domemaster { field } => {
                let across = right.hypot(up);
                let radius = across.atan2(ahead) / (field / 2.0);
                let scale = if across > 0.0 { radius / across * w.min(h) / w } else { 0.0 };
                (radius <= 1.0 && way != DVec3::ZERO).then_some((right * scale, up * scale))?
            }
        };
        let place = ((right + 1.0) * w / 2.0, (h - up * w) / 2.0);
        (place.0.is_finite() && place.1.is_finite()).then_some(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn above(lens: Lens) -> Camera {
        Camera::looking(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, DVec3::Y, lens).unwrap()
    }

    #[test]
    fn from_plus_z_row_0_is_plus_y_and_column_0_is_minus_x() {
        let camera = above(Lens::Orthographic { width: 2.0 });
        let ray = camera.ray(0.0, 0.0, 64, 64).unwrap();
        assert!((ray.origin - DVec3::new(-1.0, 1.0, 4.0)).length() < 1e-12);
        assert_eq!(ray.direction, -DVec3::Z);
    }

    #[test]
    fn the_field_of_a_perspective_is_the_full_horizontal_angle() {
        let camera = above(Lens::Perspective { field: 1.0 });
        let ray = camera.ray(64.0, 16.0, 64, 32).unwrap();
        assert!((ray.direction.angle_between(-DVec3::Z) - 0.5).abs() < 1e-12 && ray.direction.x > 0.0);
    }

    #[test]
    fn angles_of_a_domemaster_grow_with_the_distance_from_its_centre() {
        let camera = above(Lens::Domemaster { field: std::f64::consts::PI });
        let half_way = camera.ray(48.0, 32.0, 64, 64).unwrap();
        assert!((half_way.direction.angle_between(-DVec3::Z) - std::f64::consts::FRAC_PI_4).abs() < 1e-12);
        assert!(camera.ray(1.0, 1.0, 64, 64).is_none());
        assert_eq!(camera.ray(32.0, 32.0, 64, 64).unwrap().direction, -DVec3::Z);
    }

    #[test]
    fn looking_straight_up_still_has_a_right_and_a_left() {
        let camera = Camera::looking(DVec3::ZERO, DVec3::Y, DVec3::Y, Lens::Orthographic { width: 1.0 }).unwrap();
        assert!(camera.ray(0.0, 0.0, 2, 2).unwrap().origin.is_finite());
        assert!(Camera::looking(DVec3::ZERO, DVec3::ZERO, DVec3::Y, Lens::Orthographic { width: 1.0 }).is_none());
    }

    #[test]
    fn a_point_is_drawn_where_its_ray_goes() {
        for lens in
            [Lens::Orthographic { width: 3.0 }, Lens::Perspective { field: 1.2 }, Lens::Domemaster { field: 3.5 }]
        {
            let camera = Camera::looking(DVec3::new(0.3, -2.0, 1.0), DVec3::X, DVec3::Y, lens).unwrap();
            let ray = camera.ray(27.3, 11.8, 64, 40).unwrap();
            let (x, y) = camera.place(ray.origin + ray.direction * 2.5, 64, 40).unwrap();
            assert!((x - 27.3).hypot(y - 11.8) < 1e-9, "{lens:?}: {x} {y}");
        }
    }
}
